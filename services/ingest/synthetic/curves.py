"""How a healthy adult's joints move over one stride, as truncated Fourier series of the stride phase.

Phase is counted in strides from the leg's own initial contact. Angles are departures from quiet standing, so the
anterior tilt that most people stand with is not in the hip. The knots are round numbers drawn by eye after the
shape that every gait laboratory reports, then moved by a few degrees until heel, ball and both legs agree on one
height and speed of the pelvis in double support; they are not a recording of anybody.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from services.ingest.synthetic.jets import Array, Curve, smooth_step, sum_of

HARMONICS = 6
STANCE = 0.62
"""Share of the stride during which the foot is on the ground, at every speed."""
DOUBLE_SUPPORT = STANCE - 0.5

_KNOTS_PER_CENT_DEG: dict[str, list[tuple[float, float]]] = {
    "hip_flexion": [
        (0, 24), (10, 26), (20, 15.5), (30, 2), (40, -10.5), (50, -17), (55, -17.5), (60, -14), (70, 5.5),
        (80, 20.5), (88, 30.5),
    ],
    "knee_flexion": [
        (0, 2), (7, 12), (13, 18.5), (20, 13.5), (30, 8), (40, 5.5), (50, 13.5), (56, 21), (62, 35), (68, 54),
        (73, 64), (80, 51.5), (88, 25.5), (95, 7.5),
    ],
    "hip_adduction": [(0, 0), (15, 5), (35, 3), (50, 0), (62, -5), (75, -4), (90, -1)],
    "hip_internal_rotation": [(0, -2), (15, 2), (35, 3), (55, 1), (75, -3), (90, -3)],
    "knee_adduction": [(0, 0), (20, 1), (50, 0), (75, 2), (90, 0.5)],
    "knee_internal_rotation": [(0, 0), (15, 3), (40, 1), (60, 3), (75, 1), (90, -2)],
    "pelvis_rotation": [(0, 5), (25, 0), (50, -5), (75, 0)],
    "pelvis_tilt": [(0, -1), (25, 1), (50, -1), (75, 1)],
    "pelvis_obliquity": [(0, 0), (14, 4), (36, 1), (50, 0), (64, -4), (86, -1)],
}  # fmt: skip


@dataclass(frozen=True)
class FourierCurve:
    """f(phase) = mean + sum over k of cosine[k] cos 2 pi k phase + sine[k] sin 2 pi k phase, rad."""

    mean: float
    cosine: NDArray[np.float64]
    sine: NDArray[np.float64]

    def __call__(self, phase: Array) -> tuple[Array, Array, Array]:
        """Value, first and second derivative with respect to the phase in strides."""
        k = 2 * math.pi * np.arange(1, len(self.cosine) + 1)
        angle = np.outer(phase, k)
        cos, sin = np.cos(angle), np.sin(angle)
        value = self.mean + cos @ self.cosine + sin @ self.sine
        first = cos @ (k * self.sine) - sin @ (k * self.cosine)
        second = -(cos @ (k**2 * self.cosine) + sin @ (k**2 * self.sine))
        return value, first, second

    def scaled(self, factor: float) -> "FourierCurve":
        """Times a constant."""
        return FourierCurve(factor * self.mean, factor * self.cosine, factor * self.sine)


def series_through(knots: list[tuple[float, float]]) -> FourierCurve:
    """A periodic spline through the knots (per cent of the stride, deg), cut to the first harmonics; rad."""
    closed = [*knots, (knots[0][0] + 100, knots[0][1])]
    spline = CubicSpline([x / 100 for x, _ in closed], [math.radians(y) for _, y in closed], bc_type="periodic")
    samples = np.arange(256) / 256
    spectrum = np.fft.rfft(spline(samples)) / len(samples)
    kept = spectrum[1 : HARMONICS + 1]
    return FourierCurve(float(spectrum[0].real), 2 * kept.real, -2 * kept.imag)


JOINT_CURVES: dict[str, FourierCurve] = {name: series_through(knots) for name, knots in _KNOTS_PER_CENT_DEG.items()}
"""By degree of freedom without its side; the pelvis in phase with the right leg."""

HEEL_STRIKE_PITCH = math.radians(14)
"""rad, toes up at initial contact."""
HEEL_RISE_PITCH = math.radians(42)
"""rad, heel up in early swing."""
FLAT_FROM, FLAT_TO = 0.105, 0.385
"""The foot is flat on the ground between these phases."""

FOOT_PITCH: Curve = sum_of(
    [
        (HEEL_STRIKE_PITCH, lambda phase: (np.ones_like(phase), np.zeros_like(phase), np.zeros_like(phase))),
        (-HEEL_STRIKE_PITCH, smooth_step(0.0, FLAT_FROM)),
        (-HEEL_RISE_PITCH, smooth_step(FLAT_TO, 0.79)),
        (HEEL_RISE_PITCH + HEEL_STRIKE_PITCH, smooth_step(0.63, 0.93)),
    ]
)
"""Pitch of the foot against the ground, rad, toes up positive, over one stride (argument in 0 .. 1)."""

ONTO_FOREFOOT: Curve = smooth_step(FLAT_FROM, FLAT_TO)
"""Share of the foot's load that the ball of the foot carries; the heel has the rest."""


@dataclass(frozen=True)
class GaitCurves:
    """How a person's joints and feet move over one stride at amplitude 1."""

    joints: Mapping[str, FourierCurve]
    """rad, by degree of freedom without its side, as in JOINT_CURVES."""
    foot_pitch: Curve
    """rad, as FOOT_PITCH."""
    onto_forefoot: Curve
    """As ONTO_FOREFOOT."""


WALKING = GaitCurves(JOINT_CURVES, FOOT_PITCH, ONTO_FOREFOOT)


def support_curve(opposite_contact: float) -> Curve:
    """Share of the body that the right foot carries over the right leg's stride; the left foot has the rest.

    It rises while the left foot pushes off and falls from the left foot's contact (at `opposite_contact`) on.
    """
    left_toe_off = opposite_contact + STANCE - 1
    return sum_of([(1.0, smooth_step(0.0, left_toe_off)), (-1.0, smooth_step(opposite_contact, STANCE))])
