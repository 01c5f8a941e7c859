"""How far two learned strides are apart: legs of one person, visits of one person, a person and an exemplar.

A leg is its joints' angles over the stride phase W, each about its mean: q_j(W) = Re sum_k z_jk exp(i k W),
z = cosine - i sine (rad). Two legs may have their phase zero anywhere, so one shift s, common to all joints, is free:

    D(a, b)  = min over s of sqrt( 1/J sum_j mean over W of (a_j(W) - b_j(W + s))^2 )
             = min over s of sqrt( 1/(2J) sum_jk |a_jk - b_jk exp(i k s)|^2 )                              rad
    rho      = Re sum_jk conj(a_jk) b_jk exp(i k s) / (|a| |b|)   at the same s
    shape    = sqrt(1 - rho^2), 1 where rho < 0: what is left of a when b may be scaled by one common factor

D is 0 for equal legs, symmetric, and in the unit of the angles; the shape distance lies between 0 and 1 and does not
change when either leg moves more or less. Neither depends on the stride frequency, because angles are compared over
phase. The strides' scatter alone makes D positive: `chance` is the root mean square distance that two means of the
same gait would have, sqrt(1/J sum_jk (s_a^2/n_a + s_b^2/n_b)).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

SHIFTS = 360
REFINEMENTS = 4
"""Newton steps from the best of the even shifts; three leave less than 1e-9 rad."""


class Leg(NamedTuple):
    """Mean stride of J joints with the scatter of the strides it was learned from."""

    cosine: FloatArray
    """rad, shape (J, N)."""
    sine: FloatArray
    """rad, shape (J, N)."""
    spread: FloatArray
    """rad, shape (J, N): standard deviation over the strides of either coefficient."""
    strides: int


class Comparison(NamedTuple):
    """Distance of two legs, see the head of this file."""

    distance: float
    """rad."""
    shape: float
    """1."""
    shift: float
    """rad, in (-pi, pi]: b has at phase W + shift what a has at W."""
    stride_spread: float
    """rad: root mean square distance of single strides from their mean, of both legs together."""
    chance: float
    """rad: distance that two means of the same gait have by the strides' scatter alone."""
    shape_chance: float
    """1: the same for the shape distance."""
    shift_std: float
    """rad: standard deviation of the shift by the strides' scatter."""


def compare_legs(a: Leg, b: Leg) -> Comparison:
    """Distance of two legs with the same joints and harmonics; legs that do not move at all are 0 apart in angle.

    Raises:
        ValueError: the legs have other joints or harmonics.
    """
    if a.cosine.shape != b.cosine.shape:
        raise ValueError(f"legs of shape {a.cosine.shape} and {b.cosine.shape} cannot be compared: same joints needed")
    first, second = a.cosine - 1j * a.sine, b.cosine - 1j * b.sine
    order = np.arange(1, first.shape[1] + 1)
    shift = best_shift((np.conj(first) * second).sum(axis=0))
    shifted = second * np.exp(1j * order * shift)
    joints = first.shape[0]
    norms = float(np.linalg.norm(first) * np.linalg.norm(second))
    rho = float((np.conj(first) * shifted).real.sum()) / norms if norms > 0.0 else 0.0
    variance = a.spread**2 / max(a.strides, 1) + b.spread**2 / max(b.strides, 1)
    chance = float(np.sqrt(variance.sum() / joints))
    slope = (order**2 * np.abs(second) ** 2).sum()
    return Comparison(
        distance=float(np.linalg.norm(first - shifted) / np.sqrt(2.0 * joints)),
        shape=float(np.sqrt(max(1.0 - rho**2, 0.0))) if rho > 0.0 else 1.0,
        shift=shift,
        stride_spread=float(np.sqrt((a.spread**2 + b.spread**2).sum() / (2.0 * joints))),
        chance=chance,
        shape_chance=min(1.0, chance * float(np.sqrt(2.0 * joints / norms))) if norms > 0.0 else 1.0,
        shift_std=float(np.sqrt((variance * order**2 * np.abs(second) ** 2).sum()) / slope) if slope > 0.0 else np.pi,
    )


def best_shift(products: ComplexArray) -> float:
    """Shift s (rad, in (-pi, pi]) that maximises Re sum_k products_k exp(i k s), (N,) products of the harmonics."""
    order = np.arange(1, products.size + 1)
    shifts = np.arange(SHIFTS) * (2.0 * np.pi / SHIFTS)
    values = (products * np.exp(1j * np.outer(shifts, order))).real.sum(axis=1)
    shift = float(shifts[np.argmax(values)])
    for _ in range(REFINEMENTS):
        turned = products * np.exp(1j * order * shift)
        slope, curvature = float((-order * turned.imag).sum()), float((-(order**2) * turned.real).sum())
        if curvature < 0.0:
            shift -= min(max(slope / curvature, -np.pi / SHIFTS), np.pi / SHIFTS)
    return float(np.pi - (np.pi - shift) % (2.0 * np.pi))
