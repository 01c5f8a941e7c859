"""The slope over all visits. No verdict rests on it: that one counts from the frozen baseline."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from scipy.stats import t as student

from services.progress.estimates import Z95, Estimate

LEAST_VISITS = 3
"""Visits below which a slope has no error."""


@dataclass(frozen=True, slots=True)
class Trend:
    """Change per day with its 95 % interval, in the unit of the measure."""

    slope_per_day: float
    low: float
    high: float
    visits: int
    days: float
    """From the first visit to the last."""


def trend(days: Sequence[float], values: Sequence[Estimate]) -> Trend | None:
    """Weighted least squares, weights w = 1 / s^2 of the visits' own errors; null below three visits or on one day.

    slope = sum w (t - T)(x - X) / S, S = sum w (t - T)^2, T and X the weighted means. Its variance is max(1, chi^2 /
    (n - 2)) / S: visits that scatter more than their intervals say widen it. Interval by Student's t with n - 2.
    """
    count = len(values)
    if count < LEAST_VISITS or max(days) == min(days):
        return None
    widest = max(each.own for each in values)
    # A visit without any stated error would take the whole weight.
    weights = [(Z95 / max(each.own, 1e-3 * widest, 1e-12)) ** 2 for each in values]
    total = sum(weights)
    middle = sum(w * day for w, day in zip(weights, days, strict=True)) / total
    mean = sum(w * each.value for w, each in zip(weights, values, strict=True)) / total
    spread = sum(w * (day - middle) ** 2 for w, day in zip(weights, days, strict=True))
    product = sum(w * (d - middle) * (x.value - mean) for w, d, x in zip(weights, days, values, strict=True))
    slope = product / spread
    misfit = sum(
        w * (x.value - mean - slope * (d - middle)) ** 2 for w, d, x in zip(weights, days, values, strict=True)
    )
    error = math.sqrt(max(1.0, misfit / (count - 2)) / spread)
    half = float(student.ppf(0.975, count - 2)) * error
    return Trend(slope, slope - half, slope + half, count, max(days) - min(days))
