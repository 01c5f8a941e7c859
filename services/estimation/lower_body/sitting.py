"""Sitting that was taken for standing, seen afterwards: whoever rises from it turns the thighs back by a right angle.

A thigh sensor worn on the side cannot tell a sitting person from a standing one: its skin normal is level in both. But
from standing no thigh leans back by more than 20 to 30 degrees, in walking or otherwise upright; from sitting, every
step does.
"""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.session import SensorDescription
from services.estimation.lower_body.axis_search import FlexionAxis
from services.estimation.parameters import StandingParameters
from services.estimation.samples import FORCE, Tick
from services.estimation.standing import THIGHS, StandingReference

Array = NDArray[np.float64]


def rose_from_sitting(
    reference: StandingReference,
    axes: Mapping[int, FlexionAxis],
    sensors: Sequence[SensorDescription],
    ticks: Sequence[Tick],
    limits: StandingParameters,
) -> bool:
    """Some thigh leans back against the reference for `risen_s` in all, as only a risen one does."""
    thighs = [
        s
        for s, axis in axes.items()
        if sensors[s].segment in THIGHS and axis.sign_is_placed and axis.moving_s >= limits.risen_s
    ]
    if not thighs or not ticks:
        return False
    times_ns = np.array([tick.captured_ns for tick in ticks])
    starts = np.flatnonzero(np.diff(times_ns // round(limits.block_s * 1e9), prepend=-1))
    least = math.ceil(limits.risen_s / limits.block_s)
    samples, fresh = np.array([tick.samples for tick in ticks]), np.array([tick.fresh for tick in ticks])
    return any(
        np.count_nonzero(
            _leans(samples[:, s, FORCE], fresh[:, s], starts, reference.mean_force[s], axes[s].right, limits)
        )
        >= least
        for s in thighs
    )


def _leans(
    force: Array,
    fresh: NDArray[np.bool_],
    starts: NDArray[np.intp],
    up: Array,
    right: Array,
    limits: StandingParameters,
) -> NDArray[np.bool_]:
    """Per block of samples (n, 3): the thigh leans back by more than `seated_thigh`, where gravity is seen alone.

    A thigh that turns by a about +right (forward) turns the up that its sensor sees by -a.
    """
    count = np.maximum(np.add.reduceat(fresh.astype(np.float64), starts), 1.0)
    mean = np.add.reduceat(force * fresh[:, None], starts) / count[:, None]
    is_gravity = np.abs(np.linalg.norm(mean, axis=1) - limits.gravity) < limits.risen_tolerance
    back = np.arctan2(np.cross(up, mean) @ right, mean @ up - (mean @ right) * (up @ right))
    return np.asarray(is_gravity & (back > limits.seated_thigh))
