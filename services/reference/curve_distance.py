"""Sagittal curve distance (4 variables): how far mean curves lie from others of the same datum. Not the GPS."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

VARIABLES = ("pelvis_tilt", "hip_flexion", "knee_flexion", "ankle_dorsiflexion")
"""The four. The Gait Profile Score has nine, of which sensors on the legs see too few."""


@dataclass(frozen=True, slots=True)
class CurveDistance:
    """Distance of one leg's curves, rad. `distance` is null unless all four variables are on both sides."""

    distance: float | None
    by_variable: dict[str, float]
    missing: tuple[str, ...]


def curve_distance(curves: Mapping[str, Sequence[float]], others: Mapping[str, Sequence[float]]) -> CurveDistance:
    """Curves by degree of freedom without side, rad at 0, 1, ... 100 %; others likewise.

    Of each variable v: g_v = sqrt(mean_k (x_v(k) - y_v(k))^2), the Gait Variable Score of Baker 2009 with other curves
    in place of the norm; the distance is sqrt(mean_v g_v^2).
    """
    by_variable = {
        name: root_mean_square(curves[name], others[name]) for name in VARIABLES if name in curves and name in others
    }
    missing = tuple(name for name in VARIABLES if name not in by_variable)
    whole = math.sqrt(sum(value**2 for value in by_variable.values()) / len(VARIABLES))
    return CurveDistance(None if missing else whole, by_variable, missing)


def root_mean_square(one: Sequence[float], other: Sequence[float]) -> float:
    """sqrt(mean((x - y)^2)). Raises ValueError for curves of different length."""
    return math.sqrt(sum((x - y) ** 2 for x, y in zip(one, other, strict=True)) / len(one))
