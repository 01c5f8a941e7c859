"""Which measures are followed over visits, and what is known of each beforehand."""

import math
from dataclasses import dataclass
from enum import StrEnum

from services.definitions.definition import Basis
from services.definitions.table import DEFINITIONS


class Better(StrEnum):
    """Which way a measure gets better, where that can be said of every patient."""

    HIGHER = "higher"
    LOWER = "lower"
    NEARER_ONE = "nearer_one"


SMALLEST_KNEE_CHANGE = math.radians(6.0)
"""rad: smaller changes of the knee's range are never called progress (clinical conventions, rule 6.3.4, proposal)."""

LEAST_STRIDES_OF_VARIABILITY = 10
"""Strides below which variability is not compared (clinical conventions, rule 6.3.5, proposal)."""


@dataclass(frozen=True, slots=True)
class Measure:
    """What a verdict has to know of a measure by its name."""

    name: str
    better: Better | None
    smallest_change: float | None
    """In the measure's unit; null: none is set."""
    least_strides: int
    """Strides that either visit must rest on."""


_HIGHER = ("walking_speed", "stride_length", "six_minute_walk_distance", "ten_metre_walk_speed")
_LOWER = ("tug_time", "ten_metre_walk_time")
_SYMMETRY_MARKS = ("_ratio",)
_VARIABILITY_ENDS = ("_sd", "_cv")

ORDER = (
    "ten_metre_walk_speed",
    "ten_metre_walk_time",
    "six_minute_walk_distance",
    "tug_time",
    "walking_speed",
    "cadence",
    "stride_length",
    "step_length",
    "stance_fraction",
    "double_support_fraction",
    "step_time",
)
"""First in every answer, in this order (clinical conventions, section 10.3); the others follow in their own."""

_NOT_FOLLOWED_STARTS = ("rhythm_", "tug_attempts")
"""Distances from an earlier visit are no property of this one."""

_NOT_FOLLOWED = frozenset(
    definition.name for definition in DEFINITIONS if definition.export_only or definition.basis is Basis.COUNT
)
"""Counts say how much was seen; of symmetries the ratio is followed, the others are for files."""


def measure_of(name: str) -> Measure:
    """What is known of a measure; of an unknown one, that it has no better side."""
    better = None
    if name in _HIGHER:
        better = Better.HIGHER
    elif name in _LOWER:
        better = Better.LOWER
    elif any(mark in name for mark in _SYMMETRY_MARKS):
        better = Better.NEARER_ONE
    variable = name.endswith(_VARIABILITY_ENDS)
    return Measure(
        name,
        better,
        SMALLEST_KNEE_CHANGE if name.endswith("knee_flexion_range") else None,
        LEAST_STRIDES_OF_VARIABILITY if variable else 0,
    )


def is_followed(name: str) -> bool:
    """Whether a metric is compared between visits."""
    return name not in _NOT_FOLLOWED and not name.startswith(_NOT_FOLLOWED_STARTS)


def place(name: str) -> int:
    """Place of a measure in an answer; the same for all that `ORDER` does not name."""
    return ORDER.index(name) if name in ORDER else len(ORDER)
