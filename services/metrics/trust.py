"""How far each number may be relied on: every reason against it, by one table of rules, and the grade that follows."""

from collections.abc import Mapping, Sequence

from schemas.metrics import Doubt, DoubtKind, Metric, TrustGrade
from schemas.quality import DataQuality, SourceQuality
from schemas.session import SessionDescription
from services.definitions.definition import ANGLES, Basis, Definition
from services.definitions.table import BY_NAME
from services.metrics.inputs import Inputs, Sources
from services.metrics.intervals import Z95
from services.metrics.parameters import PLAUSIBLE, RULES, USEFUL_CHANGE, WEAK
from services.metrics.trust_words import withheld_line

GRADES = (TrustGrade.GOOD, TrustGrade.FAIR, TrustGrade.POOR, TrustGrade.WITHHELD)
OF_STRIDES = (Basis.CONTACTS, Basis.TOE_OFFS, Basis.LENGTHS, Basis.WIDTH, *ANGLES)
FILTERED = (Basis.LENGTHS, *ANGLES)
"""What the filter estimates, and settles into."""
NOT_ON_THE_BODY = "not observable from sensors on the body"
UNSEEN_FEET = "no sensor or camera tells the ankle"

Judged = tuple[TrustGrade, Doubt]
RejectedShares = Mapping[str | None, float]
"""Share of the strides that were rejected, by side; of both feet together under None."""


class Trust:
    """The judge of one session's numbers."""

    def __init__(self, description: SessionDescription) -> None:
        self._inputs = Inputs(description)

    def judged(self, metrics: Sequence[Metric], quality: DataQuality | None, rejected: RejectedShares) -> list[Metric]:
        """The same metrics with their grade and doubts; those below the bar without a value.

        `quality` is None while a session runs: what it has told by then depends on chance.
        """
        return [self._judge(metric, quality, rejected) for metric in metrics]

    def _judge(self, metric: Metric, quality: DataQuality | None, rejected: RejectedShares) -> Metric:
        definition = BY_NAME.get(metric.name)
        if definition is None or metric.value is None:
            return metric if definition is None else self._unseen(metric, definition)
        if definition.basis is Basis.COUNT:
            return metric.model_copy(update={"grade": TrustGrade.GOOD})
        found = [*_of_itself(metric, definition), *_of_strides(metric, definition, rejected)]
        if quality is not None:
            found += self._of_data(metric, definition, quality)
        found.sort(key=lambda judged: -GRADES.index(judged[0]))
        doubts = [doubt for _, doubt in found]
        grade = found[0][0] if found else TrustGrade.GOOD
        if grade is TrustGrade.WITHHELD:
            return _without_value(metric, doubts)
        return _with_interval(metric, definition).model_copy(update={"grade": grade, "doubts": doubts})

    def _unseen(self, metric: Metric, definition: Definition) -> Metric:
        """What was not observed, with a doubt that says so in any language, and why it cannot be where known."""
        if not metric.doubts:
            unseen = Doubt(kind=DoubtKind.NOT_OBSERVED, value=None, limit=None, subject=metric.side)
            metric = metric.model_copy(update={"doubts": [unseen]})
        because = {Basis.WIDTH: NOT_ON_THE_BODY, Basis.ANKLE: UNSEEN_FEET}.get(definition.basis)
        if because is None or metric.strides or self._inputs.uses_camera:
            return metric
        return metric.model_copy(update={"withheld_because": because})

    def _of_data(self, metric: Metric, definition: Definition, quality: DataQuality) -> list[Judged]:
        by_name = {source.name: source for source in quality.sources}
        choices = [_of_sources(sources, by_name) for sources in self._inputs.alternatives(definition, metric.side)]
        # Any of the alternatives is enough: the best of them decides.
        found = min(choices, key=_weight) if choices else []
        if definition.basis in FILTERED and not self._inputs.uses_camera:
            found = [*found, *_of_time(definition, quality)]
        if definition.basis in ANGLES and not definition.name.endswith("_range"):
            found = [*found, *_of_calibration(quality)]
        if definition.basis is Basis.RHYTHM and quality.moving_s > 0:
            found = [*found, *ruled(DoubtKind.NOT_LOCKED, quality.locked_s / quality.moving_s)]
        taken = sum(source.used for source in quality.sources)
        return [*found, *ruled(DoubtKind.LATE, quality.late / taken if taken else 0.0)]


def ruled(kind: DoubtKind, value: float, subject: str | None = None) -> list[Judged]:
    """The grade that a number of the data leads to, with the limit it went beyond; nothing where it is well."""
    rule = RULES[kind]
    limits = ((TrustGrade.WITHHELD, rule.withheld), (TrustGrade.POOR, rule.poor), (TrustGrade.FAIR, rule.fair))
    for grade, limit in limits:
        if limit is not None and (value < limit if rule.below else value > limit):
            return [(grade, Doubt(kind=kind, value=round(value, 6), limit=limit, subject=subject))]
    return []


def _of_itself(metric: Metric, definition: Definition) -> list[Judged]:
    value, name = metric.value or 0.0, definition.name
    found: list[Judged] = []
    if name.startswith(WEAK):
        found += ruled(DoubtKind.WEAK_MEASURE, 1.0)
    low, high = PLAUSIBLE.get(name, (value, value))
    if not low <= value <= high:
        limit = low if value < low else high
        doubt = Doubt(kind=DoubtKind.IMPLAUSIBLE, value=round(value, 6), limit=limit, subject=None)
        found.append((TrustGrade.POOR, doubt))
    useful, _ = USEFUL_CHANGE.get(name, (None, ""))
    if useful is not None and metric.low is not None and metric.high is not None:
        found += ruled(DoubtKind.WIDE_INTERVAL, (metric.high - metric.low) / 2 / useful)
    return found


def _of_strides(metric: Metric, definition: Definition, rejected: RejectedShares) -> list[Judged]:
    if definition.basis not in OF_STRIDES:
        return []
    # Of a number of both feet, each had half of the strides.
    cycles = metric.strides if metric.side or not definition.measure else metric.strides / 2
    few = ruled(DoubtKind.FEW_CYCLES, cycles, metric.side)
    return [*few, *ruled(DoubtKind.REJECTED_CYCLES, rejected.get(metric.side, 0.0), metric.side)]


def _of_sources(sources: Sources, by_name: Mapping[str, SourceQuality]) -> list[Judged]:
    found: list[Judged] = []
    for name in sorted(sources):
        source = by_name.get(name)
        if source is None:
            continue
        lost = 1.0 if source.expected == 0 else max(0.0, 1.0 - source.used / source.expected)
        found += ruled(DoubtKind.LOSS, lost, name)
        found += ruled(DoubtKind.SILENCE, source.longest_silence_s, name)
        found += ruled(DoubtKind.MISPLACED, 1.0, name) if source.misplaced else []
    return found


def _of_time(definition: Definition, quality: DataQuality) -> list[Judged]:
    # Lone feet or a lone back tell no joint, and so not when it moved.
    found = ruled(DoubtKind.WARM_UP, quality.moving_s) if quality.moving_s > 0 else []
    if definition.basis is Basis.LENGTHS and quality.spanned_s > 0:
        found += ruled(DoubtKind.COVERAGE, quality.estimated_s / quality.spanned_s)
    return found


def _of_calibration(quality: DataQuality) -> list[Judged]:
    if not quality.calibrated:
        return ruled(DoubtKind.NOT_CALIBRATED, 1.0)
    return [] if quality.absolute else ruled(DoubtKind.NOT_ABSOLUTE, 1.0)


def _weight(found: Sequence[Judged]) -> tuple[int, int]:
    return max((GRADES.index(grade) for grade, _ in found), default=0), len(found)


def _with_interval(metric: Metric, definition: Definition) -> Metric:
    """A task's numbers have the interval of their standard error alone."""
    if definition.basis is not Basis.TASK or metric.low is not None or metric.mean_std is None or metric.value is None:
        return metric
    half = Z95 * metric.mean_std
    return metric.model_copy(update={"low": metric.value - half, "high": metric.value + half})


def _without_value(metric: Metric, doubts: list[Doubt]) -> Metric:
    nothing = dict.fromkeys(("value", "spread", "mean_std", "low", "high"))
    because = withheld_line(doubts[0])
    told = {"grade": TrustGrade.WITHHELD, "doubts": doubts, "withheld_because": because}
    return metric.model_copy(update={**nothing, **told})
