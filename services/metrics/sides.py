"""One leg against the other over the stride: whether a patient recovers a leg's movement or makes up for it elsewhere.

Joukov et al., Rhythmic EKF, figure 16 and table V: root mean square difference of the paretic and the other leg's mean
curves, shifted by half a cycle. Each curve here begins with its own leg's contact, which is half a stride later on the
other side of a symmetric walk; one further shift for all joints of the leg makes up for contacts that are not.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from schemas.metrics import SideComparison
from schemas.vocabulary import Side
from services.metrics.moments import Moments

Array = NDArray[np.float64]

JOINTS = ("hip_flexion", "hip_adduction", "hip_internal_rotation", "knee_flexion")
"""Compared, where both legs were seen; those that move most tell the shift."""
SHIFTED_BY = ("hip_flexion", "knee_flexion")
LARGEST_SHIFT = 25
"""% of a stride either way; a leg further off its half stride is no late leg."""


def compare_sides(curves: Mapping[str, Moments], reference: Side, least_strides: int) -> list[SideComparison]:
    """Each joint that both legs were seen in, in enough strides; mean and spread of 101 points, rad."""
    pairs = {}
    for joint in JOINTS:
        ours, theirs = curves.get(f"{joint}_{reference.other}"), curves.get(f"{joint}_{reference}")
        if ours is not None and theirs is not None and min(ours.count, theirs.count) >= max(2, least_strides):
            pairs[joint] = (ours, theirs)
    shift = _best_shift([pairs[joint] for joint in SHIFTED_BY if joint in pairs])
    return [_compared(joint, reference, ours, theirs, shift) for joint, (ours, theirs) in pairs.items()]


def _cycle(curve: Array) -> Array:
    """(100,) without the last point, which is the first of the next stride."""
    return curve[:-1]


def _best_shift(pairs: list[tuple[Moments, Moments]]) -> int:
    """% by which the leg is moved on so that the curves about their means lie closest; the smallest of equals."""
    if not pairs:
        return 0
    shifts = sorted(range(-LARGEST_SHIFT, LARGEST_SHIFT + 1), key=abs)
    apart = [sum(_squares(ours, theirs, shift) for ours, theirs in pairs) for shift in shifts]
    return shifts[int(np.argmin(apart))]


def _squares(ours: Moments, theirs: Moments, shift: int) -> float:
    difference = np.roll(_cycle(ours.mean), shift) - _cycle(theirs.mean)
    return float(np.var(difference))


def _compared(joint: str, reference: Side, ours: Moments, theirs: Moments, shift: int) -> SideComparison:
    difference = np.roll(_cycle(ours.mean), shift) - _cycle(theirs.mean)
    # Of two means that are the same: E (a - b)^2 = s_a^2 / n_a + s_b^2 / n_b at each point.
    chance = sum(_cycle(each.squares) / (each.count - 1) / each.count for each in (ours, theirs))
    return SideComparison(
        joint=joint,
        reference_side=reference,
        rmse=round(float(np.sqrt(np.mean(difference**2))), 9),
        rmse_std=round(float(np.sqrt(np.mean(chance))), 9),
        rmse_about_mean=round(float(np.std(difference)), 9),
        shift=shift / 100.0,
        strides=min(ours.count, theirs.count),
    )
