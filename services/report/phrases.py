"""Short phrases in a report's language: grades, doubts, rules of verdicts, conditions, names of joints and sensors."""

from collections.abc import Iterable

from schemas.metrics import Doubt, DoubtKind, Metric, TrustGrade
from schemas.vocabulary import Side
from services.progress.rules import Parameter, Rule, RuleCode
from services.report.catalogue import Catalogue
from services.report.units import Measured

_SHARES = (
    DoubtKind.COVERAGE, DoubtKind.REJECTED_CYCLES, DoubtKind.LOSS, DoubtKind.LATE, DoubtKind.NOT_LOCKED,
)  # fmt: skip
_MEASURE_PARAMETERS = ("change", "low", "high", "mdc", "limit", "half_interval", "smallest")


_SIGNED = ("change", "low", "high", "speed_change", "motion_change", "distance_change")


def grade_word(words: Catalogue, grade: TrustGrade | None) -> str:
    """`Good`, `Fair`, `Poor`, `Withheld`; `Not known` for none."""
    return words.text(f"grade.{grade or 'unknown'}")


def joint_name(words: Catalogue, degree_of_freedom: str) -> str:
    """Name of a joint's movement with its side, if it has one."""
    base, side = split_side(degree_of_freedom)
    name = words.text(f"joint.{base}") if words.has(f"joint.{base}") else base.replace("_", " ")
    return name if side is None else words.text("format.brackets", text=name, inside=words.text(f"side.{side}"))


def split_side(degree_of_freedom: str) -> tuple[str, Side | None]:
    """`knee_flexion_left` as (`knee_flexion`, left)."""
    for side in Side:
        if degree_of_freedom.endswith(f"_{side}"):
            return degree_of_freedom.removesuffix(f"_{side}"), side
    return degree_of_freedom, None


def subject_name(words: Catalogue, subject: str) -> str:
    """A sensor, segment, joint or side by its name in the language; anything else as it is called."""
    for key in (f"segment.{subject}", f"side.{subject}"):
        if words.has(key):
            return words.text(key)
    base, _ = split_side(subject)
    return joint_name(words, subject).lower() if words.has(f"joint.{base}") else subject.replace("_", " ")


def doubt_text(words: Catalogue, doubt: Doubt) -> str:
    """What speaks against a number, with what was found and what would have been needed, where both are known."""
    full, plain = f"doubt.{doubt.kind}", f"doubt.{doubt.kind}_plain"
    if doubt.subject is not None and "{subject}" in words.messages.get(full, ""):
        return words.text(full, subject=subject_name(words, doubt.subject))
    if doubt.value is None or not words.has(full) or "{value}" not in words.messages[full]:
        return words.text(plain)
    factor = 100 if doubt.kind in _SHARES else 1
    limit = None if doubt.limit is None else doubt.limit * factor
    if limit is None and "{limit}" in words.messages[full]:
        return words.text(plain)
    return words.text(full, value=_plainly(words, doubt.value * factor), limit=_plainly(words, limit))


def _plainly(words: Catalogue, value: float | None) -> str:
    whole = value is not None and abs(value - round(value)) < 0.05
    return words.number(value, 0 if whole else 1)


def why_withheld(words: Catalogue, metric: Metric) -> str:
    """Why a metric has no value: its weightiest doubt."""
    if metric.doubts:
        return doubt_text(words, metric.doubts[0])
    return words.text("doubt.unsaid")


def rule_sentence(words: Catalogue, rule: Rule, measured: Measured) -> str:
    """One rule of a verdict as a sentence with its numbers in the measure's shown unit."""
    return words.text(
        f"rule.{rule.code}",
        **{name: _shown(words, name, value, rule, measured) for name, value in rule.parameters.items()},
    )


def _shown(words: Catalogue, name: str, value: Parameter, rule: Rule, measured: Measured) -> str:
    if value is None:
        return words.text("header.not_said")
    if isinstance(value, str):
        return _word(words, value)
    how = _measured(words, name, rule, measured)
    if how is not None:
        return how.full(value, signed=name in _SIGNED)
    return words.number(value, 2 if isinstance(value, float) else 0)


def _measured(words: Catalogue, name: str, rule: Rule, measured: Measured) -> Measured | None:
    """In what a parameter is shown; None for a bare number."""
    speed = Measured(words, "m/s", "walking_speed")
    if name == "speed_change" or (rule.code is RuleCode.SPEED_NOT_UP and name in ("low", "high")):
        return speed
    if name == "motion_change":
        motion = str(rule.parameters["motion"])
        return Measured(words, "m" if motion == "circumduction" else "rad", motion)
    if name == "distance_change":
        return Measured(words, "rad", "side_distance")
    return measured if name in _MEASURE_PARAMETERS else None


def _word(words: Catalogue, value: str) -> str:
    kinds = ("difference", "population", "occasion", "grade", "aid", "orthosis", "footwear", "speed", "motion")
    for kind in kinds:
        if words.has(f"{kind}.{value}"):
            text = words.text(f"{kind}.{value}")
            return text.lower() if kind == "grade" else text
    return value


def first_rule(words: Catalogue, rules: Iterable[Rule], measured: Measured) -> str:
    """The first rule as a sentence; empty where there is none."""
    return next((rule_sentence(words, each, measured) for each in rules), "")
