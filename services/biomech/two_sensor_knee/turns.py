"""Rotations as tuples, for compiled code: they live in registers, nothing is allocated.

Quaternions are (w, x, y, z). Arrays of rotations hold R_world_from_sensor with the world's y up.
"""

from math import cos, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from services.biomech.two_sensor_knee.compiled import compiled

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
Array = NDArray[np.float64]


@compiled
def product(p: Quaternion, q: Quaternion) -> Quaternion:
    """Hamilton product p q: the rotation q followed by p."""
    return (
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    )


@compiled
def unit(q: Quaternion) -> Quaternion:
    """q scaled to norm 1."""
    scale = 1.0 / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return q[0] * scale, q[1] * scale, q[2] * scale, q[3] * scale


@compiled
def turn_by(x: float, y: float, z: float) -> Quaternion:
    """Quaternion of the rotation vector (x, y, z), rad."""
    square = x * x + y * y + z * z
    if square < 0.04:
        # Series of cos(a/2) and sin(a/2)/a in h = (a/2)^2 <= 0.01, good to 3e-13.
        h = 0.25 * square
        scale = 0.5 * (1.0 - h / 6.0 * (1.0 - h / 20.0 * (1.0 - h / 42.0)))
        return 1.0 - 0.5 * h * (1.0 - h / 12.0 * (1.0 - h / 30.0)), scale * x, scale * y, scale * z
    angle = sqrt(square)
    scale = sin(0.5 * angle) / angle
    return cos(0.5 * angle), scale * x, scale * y, scale * z


@compiled
def turned(q: Quaternion, x: float, y: float, z: float) -> Vector:
    """The vector (x, y, z) rotated by q: v + 2 w (u x v) + 2 u x (u x v)."""
    tx = 2.0 * (q[2] * z - q[3] * y)
    ty = 2.0 * (q[3] * x - q[1] * z)
    tz = 2.0 * (q[1] * y - q[2] * x)
    return (
        x + q[0] * tx + q[2] * tz - q[3] * ty,
        y + q[0] * ty + q[3] * tx - q[1] * tz,
        z + q[0] * tz + q[1] * ty - q[2] * tx,
    )


@compiled
def low_pass_gain(time_s: float, dt_s: float) -> float:
    """Gain of a first-order low-pass with this time constant, for one step of dt_s (backward Euler)."""
    return dt_s / (time_s + dt_s)


@compiled
def fill_matrix(q: Quaternion, R: Array) -> None:
    """Write the rotation matrix of the unit quaternion q into R (3, 3)."""
    w, x, y, z = q
    R[0, 0] = 1.0 - 2.0 * (y * y + z * z)
    R[0, 1] = 2.0 * (x * y - w * z)
    R[0, 2] = 2.0 * (x * z + w * y)
    R[1, 0] = 2.0 * (x * y + w * z)
    R[1, 1] = 1.0 - 2.0 * (x * x + z * z)
    R[1, 2] = 2.0 * (y * z - w * x)
    R[2, 0] = 2.0 * (x * z - w * y)
    R[2, 1] = 2.0 * (y * z + w * x)
    R[2, 2] = 1.0 - 2.0 * (x * x + y * y)


@compiled
def fill_relative(R_thigh: Array, R_shank: Array, heading: float, relative: Array) -> None:
    """Write R_thigh_from_shank = R_thigh' Ry(heading) R_shank into `relative` (3, 3).

    `heading` (rad, about the world's up) turns the world of the shank's sensor into that of the thigh's.
    """
    c, s = cos(heading), sin(heading)
    for k in range(3):
        x = c * R_shank[0, k] + s * R_shank[2, k]
        y = R_shank[1, k]
        z = c * R_shank[2, k] - s * R_shank[0, k]
        for i in range(3):
            relative[i, k] = R_thigh[0, i] * x + R_thigh[1, i] * y + R_thigh[2, i] * z


@compiled
def wrapped(angle: float) -> float:
    """`angle` within (-pi, pi]."""
    if -pi < angle <= pi:
        return angle
    turns = np.floor((pi - angle) / (2.0 * pi))
    return float(angle + 2.0 * pi * turns)
