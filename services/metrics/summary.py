"""From running moments to metrics with their spread, or the reason why there is none."""

import math
from collections.abc import Sequence
from typing import NamedTuple

from schemas.metrics import Doubt, DoubtKind, MeanCurve, Metric, TrustGrade
from services.definitions.definition import Definition
from services.metrics.intervals import Z95, Interval, of_mean, of_ratio, of_spread, student_t
from services.metrics.moments import Moments


def withheld(
    definition: Definition, side: str | None, strides: int, because: str, doubts: Sequence[Doubt] = ()
) -> Metric:
    """The metric without a value, and the doubts that say why where `because` is to be said in another language."""
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
        doubts=list(doubts),
        withheld_because=because,
    )


def shown(
    definition: Definition,
    side: str | None,
    value: float,
    spread: float | None,
    mean_std: float | None,
    strides: int,
    interval: Interval | None = None,
) -> Metric:
    """The metric with its value, and its 95 % interval where it is known. Nobody has judged it yet."""
    return Metric(
        name=definition.name,
        side=side,
        unit=definition.unit,
        value=value,
        spread=spread,
        mean_std=mean_std,
        low=None if interval is None else interval.low,
        high=None if interval is None else interval.high,
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


def few(strides: int, least: int, subject: str | None = None) -> Doubt:
    """The same for a screen in another language."""
    if strides == 0:
        return Doubt(kind=DoubtKind.NOT_OBSERVED, value=None, limit=None, subject=subject)
    return Doubt(kind=DoubtKind.FEW_CYCLES, value=float(strides), limit=float(least), subject=subject)


def _too_few(definition: Definition, side: str | None, strides: int, least: int, noun: str) -> Metric:
    return withheld(definition, side, strides, too_few(strides, least, noun) or "", [few(strides, least, side)])


def independent_strides(moments: Moments, definition: Definition) -> float:
    """Number of strides, or of what else it rests on, for a standard error.

    Strides of the two feet overlap by half, so where both count, each counts half.
    """
    return moments.count if definition.per_side else max(1.0, moments.count / 2)


def mean_metric(
    definition: Definition,
    side: str | None,
    moments: Moments,
    least: int,
    noun: str = "strides",
    shared_std: float = 0.0,
) -> Metric:
    """Mean with standard deviation, standard error SD / sqrt(n), and an interval with the error that all share."""
    spread = moments.spread()
    if moments.count < least or spread is None:
        return _too_few(definition, side, moments.count, max(least, 2), noun)
    independent = independent_strides(moments, definition)
    value, error = float(moments.mean), float(spread) / math.sqrt(independent)
    interval = of_mean(value, error, independent - 1, shared_std)
    return shown(definition, side, value, float(spread), error, moments.count, interval)


class Noise(NamedTuple):
    """Scatter that measuring adds, in the units of a standard deviation and of a coefficient of variation."""

    sd: float
    cv: float


NO_NOISE = Noise(0.0, 0.0)


def variability_metrics(
    sd: Definition,
    cv: Definition,
    side: str | None,
    moments: Moments,
    least: int,
    noun: str = "strides",
    noise: Noise = NO_NOISE,
) -> tuple[Metric, Metric]:
    """SD and CV = SD / mean. Their standard error is value / sqrt(2 (n - 1)), for normally distributed strides."""
    spread, n = moments.spread(), moments.count
    if n < least or spread is None:
        return _too_few(sd, side, n, max(least, 2), noun), _too_few(cv, side, n, max(least, 2), noun)
    value, mean = float(spread), float(moments.mean)
    freedom = max(1.0, independent_strides(moments, sd) - 1)
    error = 1 / math.sqrt(2 * freedom)
    first = shown(sd, side, value, None, value * error, n, of_spread(value, freedom, noise.sd))
    if mean <= 0:
        doubt = Doubt(kind=DoubtKind.NOT_POSITIVE, value=mean, limit=0.0, subject=side)
        return first, withheld(cv, side, n, "the mean is not positive", [doubt])
    share = value / mean
    return first, shown(cv, side, share, None, share * error, n, of_spread(share, freedom, noise.cv))


def ratio_metric(
    definition: Definition, first: Metric, second: Metric, larger_first: bool = True, shared_log_std: float = 0.0
) -> Metric:
    """First / second of two means a and b, or larger / smaller; error: ratio sqrt((s_a / a)^2 + (s_b / b)^2)."""
    strides = min(first.strides, second.strides)
    if first.value is None or second.value is None:
        missing = first if first.value is None else second
        return withheld(definition, None, strides, missing.withheld_because or "", missing.doubts)
    if first.value <= 0 or second.value <= 0:
        side = first if first.value <= 0 else second
        doubt = Doubt(kind=DoubtKind.NOT_POSITIVE, value=side.value, limit=0.0, subject=side.side)
        return withheld(definition, None, strides, "the mean of a side is not positive", [doubt])
    ratio = first.value / second.value
    if larger_first:
        ratio = max(ratio, 1.0 / ratio)
    relative = math.hypot((first.mean_std or 0.0) / first.value, (second.mean_std or 0.0) / second.value)
    interval = of_ratio(ratio, log_half(first, second, shared_log_std), folded=larger_first)
    return shown(definition, None, ratio, None, ratio * relative, strides, interval)


def log_half(first: Metric, second: Metric, shared_log_std: float) -> float:
    """Half the 95 % interval of ln(a / b), of two positive means that scatter independently, to first order."""
    own = [student_t(mean.strides - 1) * (mean.mean_std or 0.0) / (mean.value or 1.0) for mean in (first, second)]
    return math.hypot(*own, Z95 * shared_log_std)


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
