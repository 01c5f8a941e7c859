"""Where the legs are and how the shanks turn, from the joint coordinates of the lower body.

Frames are ISB: x forward, y up, z right. The heading frame has the pelvis centre as origin and turns with
pelvis_rotation, but neither with tilt nor with obliquity.
"""

from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

import numba
import numpy as np
from numpy.typing import NDArray

from schemas.session import Anthropometry
from schemas.vocabulary import LOWER_BODY, Side
from services.segmentation.batch import INDEX

Array = NDArray[np.float64]

SIDES = (Side.LEFT, Side.RIGHT)
"""Order of the legs in every array here."""

_AXES = np.array([next(k for k in range(3) if dof.axis[k]) for dof in LOWER_BODY])
_SIGNS = np.array([sum(dof.axis) for dof in LOWER_BODY], dtype=np.float64)
_WAY_UP = (
    "knee_internal_rotation", "knee_adduction", "knee_flexion",
    "hip_internal_rotation", "hip_adduction", "hip_flexion",
    "pelvis_obliquity", "pelvis_tilt", "pelvis_rotation",
)  # fmt: skip
# For each leg its joints from the shank up to the heading.
_JOINTS = np.array([[INDEX.get(name, INDEX.get(f"{name}_{side}", -1)) for name in _WAY_UP] for side in SIDES])
_TABLES = (_JOINTS, _AXES, _SIGNS)
_ABOVE_KNEE, _ABOVE_HIP, _HEADING = 3, 6, 8

Function = TypeVar("Function", bound=Callable[..., Any])


def _compiled(function: Function) -> Function:
    return numba.njit(cache=True)(function)  # type: ignore[no-any-return]


class LegMotion(NamedTuple):
    """Both legs (left, right) at n instants."""

    shank_rate: Array  # (n, 2) rad/s about the shank's own medio-lateral axis; positive: the ankle swings forward
    ankle: Array  # (3, n, 2) m, ankle centre in the heading frame
    knee: Array  # (3, n, 2) m, knee centre in the heading frame


def leg_motion(position: Array, velocity: Array, body: Anthropometry) -> LegMotion:
    """Forward kinematics of both legs.

    position (n, 15) rad and velocity (n, 15) rad/s in the order of LOWER_BODY. Each segment's vectors are carried
    from the shank up to the heading frame. The shank's rate about its own z axis u is the sum over the joints of
    u . e_k dq_k, where e_k is the joint's axis, the same before and after the joint's own rotation, and u is
    written in that joint's frame on the way up.
    """
    n = len(position)
    motion = LegMotion(np.zeros((n, 2)), np.zeros((3, n, 2)), np.zeros((3, n, 2)))
    lengths = (body.thigh_length_m, body.shank_length_m, 0.5 * body.hip_width_m)
    _climb(np.ascontiguousarray(position), np.ascontiguousarray(velocity), *_TABLES, *lengths, *motion)
    return motion


@_compiled
def _climb(
    position: Array,
    velocity: Array,
    joints: NDArray[np.int64],
    axes: NDArray[np.int64],
    signs: Array,
    thigh: float,
    shank: float,
    half_width: float,
    shank_rate: Array,
    ankles: Array,
    knees: Array,
) -> None:
    """Fills shank_rate, ankles and knees; see `leg_motion`."""
    vectors = np.zeros((3, 3))  # rows: shank axis u, ankle, knee
    for n in range(len(position)):
        for leg in range(2):
            vectors[:] = 0.0
            vectors[0, 2] = 1.0
            vectors[1, 1] = -shank
            for level in range(_HEADING + 1):
                if level == _ABOVE_KNEE:
                    vectors[1:, 1] -= thigh
                elif level == _ABOVE_HIP:
                    vectors[1:, 2] += half_width if leg == 1 else -half_width
                joint = joints[leg, level]
                axis, sign = axes[joint], signs[joint]
                shank_rate[n, leg] += sign * velocity[n, joint] * vectors[0, axis]
                if level == _HEADING:
                    break
                i, j = (axis + 1) % 3, (axis + 2) % 3
                c, s = np.cos(sign * position[n, joint]), np.sin(sign * position[n, joint])
                for row in range(3):
                    first, second = vectors[row, i], vectors[row, j]
                    vectors[row, i] = c * first - s * second
                    vectors[row, j] = s * first + c * second
            ankles[:, n, leg] = vectors[1]
            knees[:, n, leg] = vectors[2]
