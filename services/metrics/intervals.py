"""95 % intervals: what scatters from stride to stride, and what all strides of a session share."""

import math
from typing import NamedTuple

from scipy.special import chdtri, stdtrit

Z95 = 1.959963984540054
"""Half the width of a 95 % interval in standard deviations."""
TAIL = 0.025


class Interval(NamedTuple):
    """Lower and upper end."""

    low: float
    high: float


def student_t(freedom: float) -> float:
    """Half the width of a 95 % interval of a mean, in standard errors, with so many degrees of freedom (at least 1)."""
    return float(stdtrit(max(1.0, freedom), 1.0 - TAIL))


def of_mean(value: float, mean_std: float, freedom: float, shared_std: float = 0.0) -> Interval:
    """value +- sqrt((t s)^2 + (1.96 b)^2): s the standard error over the strides, b what every stride shares."""
    half = math.hypot(student_t(freedom) * mean_std, Z95 * shared_std)
    return Interval(value - half, value + half)


def of_ratio(ratio: float, log_half: float, *, folded: bool) -> Interval:
    """Of a / b by half the interval of its logarithm.

    A ratio that is folded to larger / smaller is at least 1: the interval of a ratio that may as well be below 1
    begins there and reaches as far as it does either way.
    """
    low, high = ratio * math.exp(-log_half), ratio * math.exp(log_half)
    if folded and low < 1.0:
        return Interval(1.0, max(high, 1.0 / low))
    return Interval(low, high)


def of_spread(spread: float, freedom: float, noise_std: float = 0.0) -> Interval:
    """Of a standard deviation of normally distributed strides: spread sqrt(v / chi2), v degrees of freedom.

    Measurement adds its own scatter, so that the truth may be smaller by noise_std, as variances subtract.
    """
    freedom = max(1.0, freedom)
    low, high = (spread * math.sqrt(freedom / float(chdtri(freedom, tail))) for tail in (TAIL, 1.0 - TAIL))
    return Interval(math.sqrt(max(0.0, low**2 - noise_std**2)), high)
