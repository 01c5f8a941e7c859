"""What a right verdict is, ours and those of others on the same visits."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from schemas.metrics import Metric
from schemas.population import Population
from schemas.vocabulary import Task
from services.bench.metrics.verdict_visits import SAID, judged
from services.progress.estimates import Z95, Estimate
from services.progress.rules import Verdict
from services.progress.thresholds import Occasion, in_band, usable

REAL, WITHIN, UNDECIDED = Verdict.REAL_CHANGE, Verdict.WITHIN_MEASUREMENT_ERROR, Verdict.CANNOT_TELL


@dataclass(frozen=True)
class Case:
    """One verdict on the last of several visits beside what truly happened, m/s."""

    verdict: Verdict
    base: float
    """True speed at the first visit."""
    true: float
    """Change."""
    true_mdc: float
    """Threshold of the band in which the person truly walked at first."""
    interval: Estimate | None
    """As printed; null where nothing was comparable."""
    mdc: float
    """As frozen, by the speed that was measured at first."""
    before: Metric
    after: Metric

    @property
    def change(self) -> float:
        """Of the two values, by hand."""
        return (self.after.value or 0.0) - (self.before.value or 0.0)

    @property
    def covered(self) -> bool:
        """Whether the printed interval of the change holds the true one."""
        return self.interval is not None and self.interval.low <= self.true <= self.interval.high


def case_of(visits: Sequence[Metric], base: float, gain: float) -> Case:
    """The verdict on the last visit of a person who truly walked at `base` first and differs by `gain` now."""
    found, true_mdc = judged(list(visits)), threshold(base)
    mdc = true_mdc if found.mdc is None else found.mdc.value
    return Case(found.verdict, base, gain, true_mdc, found.change, mdc, visits[0], visits[-1])


def threshold(base: float) -> float:
    """m/s: between days, comfortable speed, chronic stroke, of the band of a speed."""
    rows = usable("walking_speed", Task.WALK, Occasion.BETWEEN_DAYS, Population.STROKE_CHRONIC, SAID.speed_instruction)
    row = in_band(rows, base)
    assert row is not None
    return row.value


Judge = Callable[[Case], Verdict]


def ours(case: Case) -> Verdict:
    """As progress says."""
    return case.verdict


def threshold_alone(case: Case) -> Verdict:
    """What is done by hand: the difference of two values against the published threshold."""
    return REAL if abs(case.change) > case.mdc else WITHIN


def strides_alone(case: Case) -> Verdict:
    """A two-sample t-test over the strides of the two visits, without any threshold; at 5 %, normal quantile."""
    errors = [(metric.spread or 0.0) / math.sqrt(max(1, metric.strides)) for metric in (case.before, case.after)]
    return REAL if abs(case.change) > Z95 * math.hypot(*errors) else WITHIN


def is_right(case: Case, judge: Judge) -> bool:
    """Real change: the true change is beyond the MDC, and that way. Within measurement error: it is not beyond.

    Cannot tell states that the interval of the change reaches over the MDC, so it is right when that interval holds
    the true change: nothing that is printed is untrue then. How often that is said is told beside.
    """
    verdict = judge(case)
    if verdict is UNDECIDED:
        return case.covered
    if verdict is REAL:
        return abs(case.true) > case.true_mdc and case.true * case.change > 0
    return abs(case.true) <= case.true_mdc


def share(cases: Sequence[Case], holds: Callable[[Case], bool]) -> float:
    """% of the cases."""
    return 100.0 * float(sum(map(holds, cases))) / len(cases) if cases else math.nan
