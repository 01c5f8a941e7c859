"""The axis without orientations: Seel and Schauer 2012, from the rates alone. Baseline of the benchmark."""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

Array = NDArray[np.float64]

STARTS = ((0.3, 0.3, 0.3, 0.3), (0.3, 1.8, 0.3, 1.8), (1.2, 0.3, 1.2, 1.8), (-0.8, 1.0, 0.8, 1.0))


def seel_axis(rate: Array) -> Array:
    """Axis (2, 3) in both sensors from rates (n, 2, 3): what is left of each rate across its axis has equal length.

    min sum (|w1 x j1| - |w2 x j2|)^2 over both directions as spherical angles, from several starts. The sense of each
    axis stays open.
    """

    square = np.sum(rate**2, axis=2)

    def across(s: int, angles: Array) -> Array:
        along = rate[:, s] @ _direction(*angles[2 * s : 2 * s + 2])
        return np.asarray(np.sqrt(np.maximum(square[:, s] - along**2, 0.0)))

    def misfit(angles: Array) -> Array:
        return across(0, angles) - across(1, angles)

    best = min((least_squares(misfit, start) for start in STARTS), key=lambda solution: float(solution.cost))
    return np.stack([_direction(*best.x[:2]), _direction(*best.x[2:])])


def _direction(inclination: float, azimuth: float) -> Array:
    return np.array([np.cos(inclination) * np.cos(azimuth), np.cos(inclination) * np.sin(azimuth), np.sin(inclination)])
