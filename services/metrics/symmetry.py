"""Both sides' means against each other: the ratio that is shown, and what other people compute from the same two."""

import math
from collections.abc import Callable, Mapping

from schemas.metrics import Metric
from schemas.vocabulary import Side
from services.definitions.definition import Definition
from services.definitions.symmetry import (
    ANGLE_SUFFIX,
    INDEX_SUFFIX,
    LOG_SUFFIX,
    OTHER_SYMMETRY,
    PARETIC_RATIOS,
    RATIOS,
    RATIOS_OF,
)
from services.metrics import summary
from services.metrics.intervals import Interval

LogStd = Callable[[Definition], float]
Means = Mapping[tuple[str, str | None], Metric]
"""Metrics by name and side."""


def no_shared_error(_: Definition) -> float:
    """Nothing is known but how strides scatter."""
    return 0.0


def symmetry_metrics(means: Means, paretic_side: Side | None, log_std: LogStd = no_shared_error) -> list[Metric]:
    """The ratios, paretic / other where a side is declared and larger / smaller otherwise; then those for export.

    `log_std` tells what of a ratio's error no number of strides averages out.
    """
    definitions = RATIOS if paretic_side is None else PARETIC_RATIOS
    first = paretic_side or Side.LEFT
    ratios = [
        summary.ratio_metric(
            definition, means[name, first], means[name, first.other], paretic_side is None, log_std(definition)
        )
        for name, definition in zip(RATIOS_OF, definitions, strict=True)
    ]
    by_name = dict(zip(RATIOS_OF, ratios, strict=True))
    return [*ratios, *(_other(definition, means, by_name, log_std(definition)) for definition in OTHER_SYMMETRY)]


def _other(definition: Definition, means: Means, ratios: Mapping[str, Metric], shared_log_std: float) -> Metric:
    """Of the same two means; `ln ratio` scatters alike whichever way it is written."""
    suffix = next(each for each in (INDEX_SUFFIX, LOG_SUFFIX, ANGLE_SUFFIX) if definition.name.endswith(each))
    name = definition.name.removesuffix(suffix)
    ratio = ratios[name]
    if ratio.value is None:
        return summary.withheld(definition, None, ratio.strides, ratio.withheld_because or "", ratio.doubts)
    of_left, of_right = means[name, Side.LEFT], means[name, Side.RIGHT]
    left, right = of_left.value or 1.0, of_right.value or 1.0
    value, per_log = {
        INDEX_SUFFIX: (2.0 * (right - left) / (right + left), 4.0 * left * right / (left + right) ** 2),
        LOG_SUFFIX: (math.log(ratio.value), 1.0),
        ANGLE_SUFFIX: (symmetry_angle(left, right), 2.0 / math.pi * left * right / (left**2 + right**2)),
    }[suffix]
    relative = (ratio.mean_std or 0.0) / ratio.value
    half = per_log * summary.log_half(of_left, of_right, shared_log_std)
    interval = Interval(value - half, value + half)
    if suffix == LOG_SUFFIX and ratio.low is not None and ratio.high is not None:
        interval = Interval(math.log(ratio.low), math.log(ratio.high))
    return summary.shown(definition, None, value, None, per_log * relative, ratio.strides, interval)


def symmetry_angle(left: float, right: float) -> float:
    """(45 deg - arctan(left / right)) / 90 deg, of positive values; in (-0.5, 0.5) (Zifchock 2008)."""
    return (math.pi / 4 - math.atan2(left, right)) / (math.pi / 2)
