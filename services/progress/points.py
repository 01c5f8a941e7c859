"""One measure of one session, and whether it may be compared."""

from dataclasses import dataclass
from datetime import date

from schemas.metrics import Metric, TrustGrade
from services.progress.baseline import ENOUGH
from services.progress.estimates import Z95, Estimate
from services.progress.likeness import differences, unsaid
from services.progress.measures import Measure
from services.progress.rules import Rule, RuleCode, rule
from services.progress.visits import Trial, Visit


@dataclass(frozen=True, slots=True)
class Point:
    """A value of one session, in the unit of its series; `rules` say why it is not comparable."""

    visit: int
    day: date
    session: str
    value: float | None
    low: float | None
    high: float | None
    grade: TrustGrade
    strides: int
    software: str
    comparable: bool
    rules: list[Rule]

    @property
    def estimate(self) -> Estimate:
        """Value with interval; only of a comparable one."""
        assert self.value is not None
        assert self.low is not None
        assert self.high is not None
        return Estimate(self.value, self.low, self.high)


def point(visit: Visit, trial: Trial, measure: Measure, metric: Metric, baseline: Trial | None) -> Point:
    """What a session says of a measure, set against the session that progress counts from."""
    assert trial.metrics is not None
    low, high = interval(metric)
    rules = _of_itself(metric, measure, low) + unsaid(trial)
    if baseline is not None:
        rules += differences(trial, baseline, metric.unit)
    return Point(
        visit=visit.number,
        day=visit.day,
        session=trial.session,
        value=metric.value,
        low=low,
        high=high,
        grade=metric.grade,
        strides=metric.strides,
        software=trial.metrics.software,
        comparable=not rules,
        rules=rules,
    )


def interval(metric: Metric) -> tuple[float | None, float | None]:
    """The 95 % interval of a metric as told; older writers told only the standard error: value -+ 1.96 of it."""
    if metric.low is not None and metric.high is not None:
        return metric.low, metric.high
    if metric.value is None or metric.mean_std is None:
        return None, None
    return metric.value - Z95 * metric.mean_std, metric.value + Z95 * metric.mean_std


def _of_itself(metric: Metric, measure: Measure, low: float | None) -> list[Rule]:
    if metric.value is None:
        return [rule(RuleCode.NO_VALUE, metric.withheld_because)]
    rules = []
    if metric.grade not in ENOUGH:
        rules.append(rule(RuleCode.GRADE_TOO_LOW, metric.grade))
    if metric.strides < measure.least_strides:
        rules.append(rule(RuleCode.TOO_FEW_STRIDES, metric.strides, measure.least_strides))
    if low is None:
        rules.append(rule(RuleCode.NO_INTERVAL))
    return rules
