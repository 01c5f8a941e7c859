"""From running moments to metrics with their spread, or the reason why there is none."""

import math

from schemas.metrics import MeanCurve, Metric, TrustGrade
from services.definitions.definition import Definition
from services.metrics.moments import Moments


def withheld(definition: Definition, side: str | None, strides: int, because: str) -> Metric:
    """The metric without a value."""
    return Metric(
        name=definition.name,
        side=side,
        unit=definition.unit,
        value=None,
        spread=None,
        mean_std=None,
        low=None,
        high=None,
        strides=strides,
        grade=TrustGrade.WITHHELD,
        doubts=[],
        withheld_because=because,
    )


def shown(
    definition: Definition, side: str | None, value: float, spread: float | None, mean_std: float | None, strides: int
) -> Metric:
    """The metric with its value."""
    return Metric(
        name=definition.name,
        side=side,
        unit=definition.unit,
        value=value,
        spread=spread,
        mean_std=mean_std,
        low=None,
        high=None,
        strides=strides,
        grade=TrustGrade.FAIR,
        doubts=[],
        withheld_because=None,
    )


def too_few(strides: int, least: int, noun: str = "strides") -> str | None:
    """Why a number is withheld; None when it rests on enough strides, or on enough of what `noun` says."""
    if strides >= least:
        return None
    if strides or noun != "strides":
        return f"{strides} of at least {least} {noun}"
    return "not observed in any stride that counts"


def independent_strides(moments: Moments, definition: Definition) -> float:
    """Number of strides, or of what else it rests on, for a standard error.

    Strides of the two feet overlap by half, so where both count, each counts half.
    """
    return moments.count if definition.per_side else max(1.0, moments.count / 2)


def mean_metric(
    definition: Definition, side: str | None, moments: Moments, least: int, noun: str = "strides"
) -> Metric:
    """Mean with standard deviation and standard error SD / sqrt(n)."""
    because = too_few(moments.count, least, noun)
    spread = moments.spread()
    if because is not None or spread is None:
        return withheld(definition, side, moments.count, because or too_few(moments.count, 2, noun) or "")
    error = float(spread) / math.sqrt(independent_strides(moments, definition))
    return shown(definition, side, float(moments.mean), float(spread), error, moments.count)


def variability_metrics(
    sd: Definition, cv: Definition, side: str | None, moments: Moments, least: int, noun: str = "strides"
) -> tuple[Metric, Metric]:
    """SD and CV = SD / mean. Their standard error is value / sqrt(2 (n - 1)), for normally distributed strides."""
    because = too_few(moments.count, least, noun)
    spread = moments.spread()
    if because is not None or spread is None:
        because = because or too_few(moments.count, 2, noun) or ""
        return withheld(sd, side, moments.count, because), withheld(cv, side, moments.count, because)
    value, mean, n = float(spread), float(moments.mean), moments.count
    error = 1 / math.sqrt(2 * max(1.0, independent_strides(moments, sd) - 1))
    first = shown(sd, side, value, None, value * error, n)
    if mean <= 0:
        return first, withheld(cv, side, n, "the mean is not positive")
    return first, shown(cv, side, value / mean, None, value / mean * error, n)


def ratio_metric(definition: Definition, first: Metric, second: Metric, larger_first: bool = True) -> Metric:
    """First / second of two means a and b, or larger / smaller; error: ratio sqrt((s_a / a)^2 + (s_b / b)^2)."""
    strides = min(first.strides, second.strides)
    if first.value is None or second.value is None:
        return withheld(definition, None, strides, first.withheld_because or second.withheld_because or "")
    if first.value <= 0 or second.value <= 0:
        return withheld(definition, None, strides, "the mean of a side is not positive")
    ratio = first.value / second.value
    if larger_first:
        ratio = max(ratio, 1.0 / ratio)
    relative = math.hypot((first.mean_std or 0.0) / first.value, (second.mean_std or 0.0) / second.value)
    return shown(definition, None, ratio, None, ratio * relative, strides)


def mean_curve(degree_of_freedom: str, moments: Moments, least: int) -> MeanCurve | None:
    """Mean and standard deviation over the stride; None when there are too few strides."""
    spread = moments.spread()
    if spread is None or moments.count < least:
        return None
    # Six decimals, 1e-6 rad, keep the message short.
    return MeanCurve(
        degree_of_freedom=degree_of_freedom,
        strides=moments.count,
        mean=moments.mean.round(6).tolist(),
        spread=spread.round(6).tolist(),
    )
