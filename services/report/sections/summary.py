"""The summary in plain words: every sentence comes from one rule and contains its number."""

from collections.abc import Callable, Iterator

from schemas.metrics import Metric
from schemas.vocabulary import Side, Task
from services.definitions.definition import PARETIC_RATIO_SUFFIX, RATIO_SUFFIX
from services.progress.rules import Verdict
from services.report.catalogue import Catalogue
from services.report.content import Section, SectionId
from services.report.phrases import first_rule, why_withheld
from services.report.sections.cells import place
from services.report.sections.exercise_sentences import exercise_sentences
from services.report.sections.measure_table import current
from services.report.sections.reference_note import short_origin
from services.report.sections.scope import EXERCISES, in_scope
from services.report.sections.test_sentences import test_sentences
from services.report.source import ReportSource
from services.report.units import Measured

MOST_CHANGES = 3
"""Sentences about changes at most; the table has all of them."""
CHANGES_OF = (
    "six_minute_walk_distance", "ten_metre_walk_speed", "tug_time", "walking_speed", "step_length", "cadence",
    "stride_length", "stance_fraction", "knee_flexion_range", "repetition_range",
)  # fmt: skip
SYMMETRY_OF = "step_length"

Rule = Callable[[ReportSource, Catalogue], Iterator[str]]


def summary(source: ReportSource, words: Catalogue) -> Section:
    """The section; it always has at least one sentence."""
    rules: tuple[Rule, ...] = (*_RULES_BY_TASK.get(source.description.task, _WALK), _changes, _withheld)
    if source.description.task in EXERCISES:
        rules = (exercise_sentences, _changes, _withheld)
    sentences = [sentence for rule in rules for sentence in rule(source, words)]
    if not any(metric.value is not None for metric in in_scope(source) if not _is_count(metric)):
        sentences = [_nothing(source, words)]
    return Section(
        id=SectionId.SUMMARY, page=1, title=words.text("title.summary"), sentences=sentences, charts=[], table=None,
        notes=[],
    )  # fmt: skip


def _is_count(metric: Metric) -> bool:
    return metric.name.startswith(("strides_", "repetitions_", "tug_attempts"))


def _nothing(source: ReportSource, words: Catalogue) -> str:
    withheld = [metric for metric in in_scope(source) if metric.value is None and metric.doubts]
    if not withheld:
        return words.text("summary.nothing_plain")
    return words.text("summary.nothing", reason=why_withheld(words, withheld[0]))


def _speed(source: ReportSource, words: Catalogue) -> Iterator[str]:
    speed = source.metric("walking_speed")
    if speed is None or speed.value is None:
        return
    measured = Measured.of(words, speed)
    value = measured.full(speed.value)
    if speed.low is None or speed.high is None:
        yield words.text("summary.speed_alone", value=value, strides=speed.strides)
    else:
        span = measured.span(speed.low, speed.high)
        yield words.text("summary.speed", value=value, span=span, strides=speed.strides)


def _cadence(source: ReportSource, words: Catalogue) -> Iterator[str]:
    cadence, length = source.metric("cadence"), source.metric("stride_length")
    if cadence is None or cadence.value is None:
        return
    value = Measured.of(words, cadence).full(cadence.value)
    if length is None or length.value is None:
        yield words.text("summary.cadence_alone", cadence=value)
    else:
        yield words.text("summary.cadence", cadence=value, length=Measured.of(words, length).full(length.value))


def _reference(source: ReportSource, words: Catalogue) -> Iterator[str]:
    speed, reference = source.metric("walking_speed"), source.reference("walking_speed", None)
    if speed is None or speed.value is None or reference is None:
        return
    measured = Measured.of(words, speed)
    yield words.text(
        f"summary.reference_{place(speed.value, reference)}",
        name=words.metric(speed.name),
        value=measured.full(speed.value),
        span=measured.span(reference.low, reference.high),
        who=short_origin(words, reference.origin),
    )


def _symmetry(source: ReportSource, words: Catalogue) -> Iterator[str]:
    left, right = source.metric(SYMMETRY_OF, Side.LEFT), source.metric(SYMMETRY_OF, Side.RIGHT)
    paretic, larger = source.value(SYMMETRY_OF + PARETIC_RATIO_SUFFIX), source.value(SYMMETRY_OF + RATIO_SUFFIX)
    if left is None or right is None:
        return
    measured = Measured.of(words, left)
    both = {"left": measured.full(left.value), "right": measured.full(right.value)}
    if paretic is not None and source.paretic is not None:
        side = words.text(f"side.of_{source.paretic}")
        yield words.text("summary.ratio_paretic", side=side, value=words.number(paretic, 2), **both)
    elif larger is not None:
        yield words.text("summary.ratio_larger", value=words.number(larger, 2), **both)


def _knees(source: ReportSource, words: Catalogue) -> Iterator[str]:
    found = {side: source.metric("knee_flexion_peak_swing", side) for side in Side}
    shown = {
        side: Measured.of(words, metric).full(metric.value)
        for side, metric in found.items()
        if metric is not None and metric.value is not None
    }
    if len(shown) == 2:
        yield words.text("summary.knees", left=shown[Side.LEFT], right=shown[Side.RIGHT])
    for side, value in shown.items() if len(shown) == 1 else ():
        yield words.text("summary.knee", side=words.text(f"side.of_{side}"), value=value)


def _changes(source: ReportSource, words: Catalogue) -> Iterator[str]:
    if source.progress is None or source.progress.baseline_day is None:
        return
    baseline = words.day(source.progress.baseline_day)
    told = 0
    for name in CHANGES_OF:
        for side in (None, Side.LEFT, Side.RIGHT):
            sentence = _change(source, words, name, side, baseline)
            if sentence and told < MOST_CHANGES:
                told += 1
                yield sentence


def _change(source: ReportSource, words: Catalogue, name: str, side: Side | None, baseline: str) -> str | None:
    history = source.history(name, side)
    now = current(source, history)
    if history is None or now is None or now.change is None:
        return None
    measured = Measured(words, history.unit, name)
    full = words.metric(name)
    if side is not None:
        full = words.text("format.brackets", text=full, inside=words.text(f"side.{side}"))
    change = measured.full(now.change, signed=True)
    if now.verdict is Verdict.CANNOT_TELL or now.verdict is None:
        if name not in CHANGES_OF[:4]:
            return None
        reason = first_rule(words, now.rules, measured)
        return words.text("summary.change_unknown", name=full, change=change, baseline=baseline, reason=reason).strip()
    kind = "real" if now.verdict is Verdict.REAL_CHANGE else "within"
    values = {"name": full, "change": change, "baseline": baseline, "mdc": measured.full(history.mdc)}
    return words.text(f"summary.change_{kind}", **values)


def _withheld(source: ReportSource, words: Catalogue) -> Iterator[str]:
    count = sum(metric.value is None and metric.strides > 0 for metric in in_scope(source))
    if count:
        yield words.one_or_more("summary.withheld", count)


_WALK: tuple[Rule, ...] = (_speed, _cadence, _reference, _symmetry, _knees)
_RULES_BY_TASK: dict[Task, tuple[Rule, ...]] = {
    Task.TIMED_UP_AND_GO: (test_sentences,),
    Task.SIX_MINUTE_WALK: (test_sentences, *_WALK),
    Task.TEN_METRE_WALK: (test_sentences, *_WALK),
    Task.MARCHING: (test_sentences,),
}
