"""Values with their 95 % intervals: of a session, of a visit, of a change."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

Z95 = 1.959964
"""Standard deviations either side that hold 95 % of a normal distribution."""

REPEATED_SHARE = 0.5
"""Of the variance that all strides of a session share, in what rests on the body's declared lengths: the part that is
the same at every like visit of a person, for it comes from those lengths and from how the person walks (proposal; on
the development persons of `ambula bench metrics verdicts` intervals of changes would hold 95 % with 0.8, and on others
that were looked at with less, so the rest is margin)."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """A value and its 95 % interval, all in the unit of the measure."""

    value: float
    low: float
    high: float
    repeated: float = 0.0
    """The part of `half` that errs alike, in proportion to the value, at every like visit; it drops out of changes."""

    @property
    def half(self) -> float:
        """Half the width of the interval."""
        return (self.high - self.low) / 2

    @property
    def own(self) -> float:
        """The part of `half` that is this one's own: half^2 = own^2 + repeated^2."""
        return math.sqrt(max(0.0, self.half**2 - self.repeated**2))


def over_trials(trials: Sequence[Estimate]) -> Estimate:
    """The mean of a visit's trials.

    variance of the mean = mean(s_i^2) + tau^2 / k, tau^2 = max(0, var(x_i) - mean(s_i^2)): the trials share what the
    sensors' mounting and the calibration do to them, so their own variances s_i^2 do not average out; what they
    scatter beyond that, tau, does. The repeated part stays what it is.
    """
    count = len(trials)
    mean = sum(each.value for each in trials) / count
    own = sum((each.own / Z95) ** 2 for each in trials) / count
    scatter = 0.0 if count == 1 else sum((each.value - mean) ** 2 for each in trials) / (count - 1)
    repeated = math.sqrt(sum(each.repeated**2 for each in trials) / count)
    half = math.hypot(Z95 * math.sqrt(own + max(0.0, scatter - own) / count), repeated)
    return Estimate(mean, mean - half, mean + half, repeated)


def change(before: Estimate, after: Estimate) -> Estimate:
    """after - before, with half^2 = own_before^2 + own_after^2 + (repeated_after - repeated_before)^2.

    Own errors are independent. What is repeated errs in proportion, so that only its growth with the value is left.
    """
    value = after.value - before.value
    half = math.hypot(before.own, after.own, after.repeated - before.repeated)
    return Estimate(value, value - half, value + half)
