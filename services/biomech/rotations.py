"""Rotations: matrices and quaternions. Quaternions are (w, x, y, z), unit norm; this is the only place that knows.

R_a_from_b turns components in frame b into components in frame a: v_a = R_a_from_b v_b.
"""

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def normalised(vector: Array) -> Array:
    """The unit vector along `vector` (any length). Raises ValueError for a zero vector."""
    length = float(np.linalg.norm(vector))
    if length < 1e-12:
        raise ValueError("a zero vector has no direction")
    return np.asarray(vector, dtype=np.float64) / length


def rotation_about(axis: Array, angle: float) -> Array:
    """Rotation matrix by `angle` (rad) about the unit vector `axis` (3,), right-hand rule (Rodrigues)."""
    K = skew(axis)
    return np.eye(3) + math.sin(angle) * K + (1.0 - math.cos(angle)) * (K @ K)


def skew(v: Array) -> Array:
    """The matrix whose product with u is v x u."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def quaternion_from_matrix(R: Array) -> Array:
    """Quaternion (w, x, y, z) of a rotation matrix, w >= 0. Takes the largest component first (Shepperd 1978)."""
    m: list[list[float]] = R.tolist()
    trace = m[0][0] + m[1][1] + m[2][2]
    candidates = (trace, m[0][0], m[1][1], m[2][2])
    largest = candidates.index(max(candidates))
    if largest == 0:
        components = [1.0 + trace, m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]]
    else:
        i = largest - 1
        j, k = (i + 1) % 3, (i + 2) % 3
        components = [m[k][j] - m[j][k], 0.0, 0.0, 0.0]
        components[1 + i] = 1.0 + 2.0 * m[i][i] - trace
        components[1 + j] = m[j][i] + m[i][j]
        components[1 + k] = m[k][i] + m[i][k]
    q = np.array(components)
    q /= math.sqrt(q @ q)
    return -q if q[0] < 0.0 else q


def matrix_from_quaternion(quat: Array) -> Array:
    """Rotation matrix of a quaternion (w, x, y, z) of any non-zero norm."""
    w, x, y, z = normalised(quat)
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def multiply_quaternions(p: Array, q: Array) -> Array:
    """Hamilton product p q: the rotation q followed by p."""
    w = p[0] * q[0] - p[1:] @ q[1:]
    return np.concatenate(([w], p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:])))


def frame_from_up_and_right(up: Array, right: Array) -> Array:
    """R_segment_from_sensor of an ISB segment frame, from two directions in the sensor frame.

    `up` (3,) is exact; `right` (3,) is made perpendicular to it; x = up x right points forward.
    Raises ValueError when they are parallel.
    """
    y = normalised(up)
    z = normalised(right - (right @ y) * y)
    return np.vstack([np.cross(y, z), y, z])


def angle_between(a: Array, b: Array) -> float:
    """Angle between two directions, rad, 0..pi."""
    (u, v, w), (x, y, z) = a.tolist(), b.tolist()
    # a x b in plain numbers: numpy's cross costs forty times as much for one pair.
    across = np.array([v * z - w * y, w * x - u * z, u * y - v * x])
    return math.atan2(float(np.linalg.norm(across)), float(a @ b))
