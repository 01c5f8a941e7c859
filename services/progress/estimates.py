"""Values with their 95 % intervals: of a session, of a visit, of a change."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

Z95 = 1.959964
"""Standard deviations either side that hold 95 % of a normal distribution."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """A value and its 95 % interval, all in the unit of the measure."""

    value: float
    low: float
    high: float

    @property
    def half(self) -> float:
        """Half the width of the interval."""
        return (self.high - self.low) / 2


def over_trials(trials: Sequence[Estimate]) -> Estimate:
    """The mean of a visit's trials.

    variance of the mean = mean(s_i^2) + tau^2 / k, tau^2 = max(0, var(x_i) - mean(s_i^2)): the trials share what the
    sensors' mounting and the calibration do to them, so their own variances s_i^2 do not average out; what they
    scatter beyond that, tau, does.
    """
    count = len(trials)
    mean = sum(each.value for each in trials) / count
    own = sum((each.half / Z95) ** 2 for each in trials) / count
    scatter = 0.0 if count == 1 else sum((each.value - mean) ** 2 for each in trials) / (count - 1)
    half = Z95 * math.sqrt(own + max(0.0, scatter - own) / count)
    return Estimate(mean, mean - half, mean + half)


def change(before: Estimate, after: Estimate) -> Estimate:
    """after - before; half width sqrt(h_before^2 + h_after^2): the two errors are taken as independent."""
    value, half = after.value - before.value, math.hypot(before.half, after.half)
    return Estimate(value, value - half, value + half)
