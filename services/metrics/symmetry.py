"""Both sides' means against each other: the ratio that is shown, and what other people compute from the same two."""

import math
from collections.abc import Mapping

from schemas.metrics import Metric
from schemas.vocabulary import Side
from services.definitions.definition import PARETIC_RATIO_SUFFIX, RATIO_SUFFIX, Definition
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

Means = Mapping[tuple[str, str | None], Metric]
"""Metrics by name and side."""


def symmetry_metrics(means: Means, paretic_side: Side | None) -> list[Metric]:
    """The ratios, paretic / other where a side is declared and larger / smaller otherwise; then those for export."""
    definitions = RATIOS if paretic_side is None else PARETIC_RATIOS
    suffix = RATIO_SUFFIX if paretic_side is None else PARETIC_RATIO_SUFFIX
    ratios = [
        summary.ratio_metric(definition, *_of_sides(means, name, paretic_side or Side.LEFT), suffix == RATIO_SUFFIX)
        for name, definition in zip(RATIOS_OF, definitions, strict=True)
    ]
    by_name = dict(zip(RATIOS_OF, ratios, strict=True))
    return [*ratios, *(_other(definition, means, by_name) for definition in OTHER_SYMMETRY)]


def _of_sides(means: Means, name: str, first: Side) -> tuple[Metric, Metric]:
    return means[name, first.value], means[name, first.other.value]


def _other(definition: Definition, means: Means, ratios: Mapping[str, Metric]) -> Metric:
    for suffix in (INDEX_SUFFIX, LOG_SUFFIX, ANGLE_SUFFIX):
        name = definition.name.removesuffix(suffix)
        if name != definition.name:
            break
    ratio = ratios[name]
    if ratio.value is None:
        return summary.withheld(definition, None, ratio.strides, ratio.withheld_because or "")
    left, right = (means[name, side.value].value or 0.0 for side in Side)
    relative = (ratio.mean_std or 0.0) / ratio.value
    value, per_log = {
        INDEX_SUFFIX: (2.0 * (right - left) / (right + left), 4.0 * left * right / (left + right) ** 2),
        LOG_SUFFIX: (math.log(ratio.value), 1.0),
        ANGLE_SUFFIX: (symmetry_angle(left, right), 2.0 / math.pi * left * right / (left**2 + right**2)),
    }[suffix]
    return summary.shown(definition, None, value, None, per_log * relative, ratio.strides)


def symmetry_angle(left: float, right: float) -> float:
    """(45 deg - arctan(left / right)) / 90 deg, of positive values; in (-0.5, 0.5) (Zifchock 2008)."""
    return (math.pi / 4 - math.atan2(left, right)) / (math.pi / 2)
