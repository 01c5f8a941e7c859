"""Whether a change is real: the statistical interval of both visits against the published detectable change."""

import math

from services.progress.estimates import Estimate
from services.progress.measures import Better, Measure
from services.progress.rules import Direction, Rule, RuleCode, Verdict, rule


def judge(measure: Measure, change: Estimate, mdc: float) -> tuple[Verdict, list[Rule]]:
    """Rules 6.3.4, 6.3.7 and 6.3.8 of the clinical conventions, with d the change, h half its 95 % interval, m the MDC.

    h >= m: cannot tell, for our own error is not shown to be smaller than what is to be detected.
    |d| > sqrt(m^2 + h^2): real change. 95 % of unchanged people stay within m from day to day, and within h by our own
    errors; both together are exceeded once in twenty times by somebody who has not changed.
    |d| + h < m: measurement error, for the whole interval lies within the MDC. Else nobody can tell.
    """
    limit = math.hypot(mdc, change.half)
    numbers = (change.value, change.low, change.high, mdc, limit)
    if change.half >= mdc:
        return Verdict.CANNOT_TELL, [rule(RuleCode.OWN_ERROR_NOT_SMALLER, change.half, mdc)]
    if abs(change.value) > limit:
        if measure.smallest_change is not None and abs(change.value) < measure.smallest_change:
            below = rule(RuleCode.BELOW_SMALLEST_CHANGE, change.value, measure.smallest_change)
            return Verdict.WITHIN_MEASUREMENT_ERROR, [below]
        return Verdict.REAL_CHANGE, [rule(RuleCode.CHANGE_BEYOND_MDC, *numbers)]
    if abs(change.value) + change.half < mdc:
        return Verdict.WITHIN_MEASUREMENT_ERROR, [rule(RuleCode.CHANGE_WITHIN_MDC, *numbers)]
    return Verdict.CANNOT_TELL, [rule(RuleCode.INTERVAL_REACHES_MDC, *numbers)]


def direction(measure: Measure, before: float, after: float) -> Direction | None:
    """Which way a real change goes; null where the measure has no better side."""
    if measure.better is None or after == before:
        return None
    if measure.better is Better.NEARER_ONE:
        return Direction.BETTER if abs(after - 1) < abs(before - 1) else Direction.WORSE
    rose = after > before
    return Direction.BETTER if rose == (measure.better is Better.HIGHER) else Direction.WORSE
