"""One measure of one session, and whether it may be compared."""

import math
from dataclasses import dataclass
from datetime import date

from schemas.metrics import Metric, TrustGrade
from services.definitions.definition import Basis
from services.definitions.table import BY_NAME
from services.progress.estimates import REPEATED_SHARE, Z95, Estimate
from services.progress.likeness import differences, unsaid
from services.progress.measures import Measure
from services.progress.rules import Rule, RuleCode, rule
from services.progress.trusted import is_trusted
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
    repeated: float
    """Of half the interval, what errs alike at every like visit."""

    @property
    def estimate(self) -> Estimate:
        """Value with interval; only of a comparable one."""
        assert self.value is not None
        assert self.low is not None
        assert self.high is not None
        return Estimate(self.value, self.low, self.high, self.repeated)


@dataclass(frozen=True, slots=True)
class Sitting:
    """One trial ready to be asked for every measure: its numbers by name and side, and what is unlike the baseline."""

    visit: Visit
    trial: Trial
    numbers: dict[tuple[str, str | None], Metric]
    software: str
    unlike: list[Rule]
    unlike_angles: list[Rule]


def sitting(visit: Visit, trial: Trial, baseline: Trial | None) -> Sitting:
    """A trial with final metrics, set against the one that progress counts from."""
    assert trial.metrics is not None
    missing = unsaid(trial)
    unlike, unlike_angles = (
        [*missing, *([] if baseline is None else differences(trial, baseline, unit))] for unit in ("", "rad")
    )
    numbers = {(metric.name, metric.side): metric for metric in trial.metrics.metrics}
    return Sitting(visit, trial, numbers, trial.metrics.software, unlike, unlike_angles)


def point(sitting: Sitting, measure: Measure, side: str | None) -> Point | None:
    """What a trial says of a measure; null where it does not know such a one."""
    metric = sitting.numbers.get((measure.name, side))
    if metric is None:
        return None
    low, high = interval(metric)
    rules = [
        *_of_itself(metric, measure, low),
        *(sitting.unlike_angles if metric.unit == "rad" else sitting.unlike),
    ]
    return Point(
        visit=sitting.visit.number,
        day=sitting.visit.day,
        session=sitting.trial.session,
        value=metric.value,
        low=low,
        high=high,
        grade=metric.grade,
        strides=metric.strides,
        software=sitting.software,
        comparable=not rules,
        rules=rules,
        repeated=0.0 if low is None or high is None else repeated(metric, (high - low) / 2),
    )


def interval(metric: Metric) -> tuple[float | None, float | None]:
    """The 95 % interval of a metric as told; older writers told only the standard error: value -+ 1.96 of it."""
    if metric.low is not None and metric.high is not None:
        return metric.low, metric.high
    if metric.value is None or metric.mean_std is None:
        return None, None
    return metric.value - Z95 * metric.mean_std, metric.value + Z95 * metric.mean_std


def repeated(metric: Metric, half: float) -> float:
    """Of half the interval, what the strides share and like visits repeat: of what rests on the body's lengths alone.

    Strides share all of half^2 that their standard error does not explain.
    """
    definition = BY_NAME.get(metric.name)
    if definition is None or definition.basis is not Basis.LENGTHS or metric.mean_std is None:
        return 0.0
    return math.sqrt(REPEATED_SHARE * max(0.0, half**2 - (Z95 * metric.mean_std) ** 2))


def _of_itself(metric: Metric, measure: Measure, low: float | None) -> list[Rule]:
    if metric.value is None:
        return [rule(RuleCode.NO_VALUE, metric.withheld_because)]
    rules = []
    if not is_trusted(metric):
        rules.append(rule(RuleCode.GRADE_TOO_LOW, metric.grade))
    if metric.strides < measure.least_strides:
        rules.append(rule(RuleCode.TOO_FEW_STRIDES, metric.strides, measure.least_strides))
    if low is None:
        rules.append(rule(RuleCode.NO_INTERVAL))
    return rules
