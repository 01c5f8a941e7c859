"""How two measurements of one angle agree: the error analysis of McGrath et al. 2018, sections 3.3 and 3.5."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import stats

Array = NDArray[np.float64]

LIMITS_SD = 1.96
"""Deviations that hold 95 % of normal differences (Bland and Altman 1986)."""


class Errors(NamedTuple):
    """Errors of an estimate, in the unit of the angles."""

    absolute_rmse: float  # eq. 4b
    zero_mean_rmse: float  # eq. 4c
    bias: float  # mean of estimate minus truth
    samples: int


class BlandAltman(NamedTuple):
    """Agreement of two measurements, in their unit; `slope` and `intercept` are those of estimate over truth."""

    bias: float
    lower_limit: float
    upper_limit: float
    r_squared: float
    slope: float
    intercept: float
    samples: int
    bias_p: float  # that the true bias is zero, every sample taken for independent as in the paper


def errors(estimate: Array, truth: Array) -> Errors:
    """Errors where both (n,) are finite.

    Raises:
        ValueError: there is no such sample.
    """
    difference = _differences(estimate, truth)[0]
    bias = float(np.mean(difference))
    absolute = float(np.sqrt(np.mean(difference**2)))
    return Errors(absolute, float(np.std(difference)), bias, len(difference))


def bland_altman(estimate: Array, truth: Array) -> BlandAltman:
    """Bias, limits of agreement and linear fit where both (n,) are finite.

    Raises:
        ValueError: there are fewer than three such samples, or the truth does not vary.
    """
    difference, measured = _differences(estimate, truth)
    if len(difference) < 3 or np.ptp(measured) == 0.0:
        raise ValueError("agreement needs three samples and a truth that varies")
    estimated = measured + difference
    bias, spread = float(np.mean(difference)), float(np.std(difference, ddof=1))
    slope, intercept = np.polyfit(measured, estimated, 1)
    r = float(np.corrcoef(measured, estimated)[0, 1])
    return BlandAltman(
        bias, bias - LIMITS_SD * spread, bias + LIMITS_SD * spread, r * r, float(slope), float(intercept),
        len(difference), _no_bias(bias, spread, len(difference)),
    )  # fmt: skip


def unwrapped_error(estimate: Array, truth: Array) -> Array:
    """Estimate minus truth within (-pi, pi], rad: for joints that turn further than half a circle."""
    return np.asarray(np.angle(np.exp(1j * (estimate - truth))))


def _no_bias(bias: float, spread: float, samples: int) -> float:
    """Two-sided t test; 1 where neither bias nor spread is there."""
    if spread == 0.0:
        return 1.0 if bias == 0.0 else 0.0
    return float(2.0 * stats.t.sf(abs(bias) * np.sqrt(samples) / spread, samples - 1))


def _differences(estimate: Array, truth: Array) -> tuple[Array, Array]:
    known = np.isfinite(estimate) & np.isfinite(truth)
    if not known.any():
        raise ValueError("no sample was measured by both")
    return estimate[known] - truth[known], truth[known]
