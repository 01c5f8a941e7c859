"""Three-vectors as tuples: they live in registers, nothing is allocated."""

import numpy as np
from numpy.typing import NDArray

from services.biomech.kernels.compiled import inlined

Vector = tuple[float, float, float]
Axes = tuple[Vector, Vector, Vector]
Array = NDArray[np.float64]


@inlined
def load(rows: Array, i: int) -> Vector:
    """Row i of an (n, 3) array."""
    return rows[i, 0], rows[i, 1], rows[i, 2]


@inlined
def store(rows: Array, i: int, v: Vector) -> None:
    """Write row i of an (n, 3) array."""
    rows[i, 0] = v[0]
    rows[i, 1] = v[1]
    rows[i, 2] = v[2]


@inlined
def cross(a: Vector, b: Vector) -> Vector:
    """a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@inlined
def add(a: Vector, b: Vector) -> Vector:
    """a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@inlined
def subtract(a: Vector, b: Vector) -> Vector:
    """a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@inlined
def scale(k: float, a: Vector) -> Vector:
    """k a."""
    return k * a[0], k * a[1], k * a[2]


@inlined
def rotate(R: Array, i: int, v: Vector) -> Vector:
    """R[i] v, with R of shape (n, 3, 3)."""
    return (
        R[i, 0, 0] * v[0] + R[i, 0, 1] * v[1] + R[i, 0, 2] * v[2],
        R[i, 1, 0] * v[0] + R[i, 1, 1] * v[1] + R[i, 1, 2] * v[2],
        R[i, 2, 0] * v[0] + R[i, 2, 1] * v[1] + R[i, 2, 2] * v[2],
    )


@inlined
def into(axes: Axes, v: Vector) -> Vector:
    """Components of v along three axes."""
    x, y, z = axes
    return (
        x[0] * v[0] + x[1] * v[1] + x[2] * v[2],
        y[0] * v[0] + y[1] * v[1] + y[2] * v[2],
        z[0] * v[0] + z[1] * v[1] + z[2] * v[2],
    )
