"""Where the legs are and how the shanks turn, from the joint coordinates of the lower body.

Frames are ISB: x forward, y up, z right. The heading frame has the pelvis centre as origin and turns with
pelvis_rotation, but neither with tilt nor with obliquity.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.session import Anthropometry
from schemas.vocabulary import LOWER_BODY, Side

Array = NDArray[np.float64]

SIDES = (Side.LEFT, Side.RIGHT)
"""Order of the legs in every array here."""

INDEX = {dof.name: i for i, dof in enumerate(LOWER_BODY)}
_AXIS = [next(k for k in range(3) if dof.axis[k]) for dof in LOWER_BODY]
_SIGN = np.array([sum(dof.axis) for dof in LOWER_BODY], dtype=np.float64)
_HIP = ("hip_flexion", "hip_adduction", "hip_internal_rotation")
_KNEE = ("knee_flexion", "knee_adduction", "knee_internal_rotation")
# One column per leg; the joints of the two legs turn about the same coordinate axes, only the signs differ.
_HIP_COLUMNS = np.array([[INDEX[f"{name}_{side}"] for side in SIDES] for name in _HIP])
_KNEE_COLUMNS = np.array([[INDEX[f"{name}_{side}"] for side in SIDES] for name in _KNEE])
_LEVEL_COLUMNS = np.array([[INDEX[name]] * 2 for name in ("pelvis_tilt", "pelvis_obliquity")])
_HEADING_COLUMN = INDEX["pelvis_rotation"]


class LegMotion(NamedTuple):
    """Both legs (left, right) at n instants."""

    shank_rate: Array  # (n, 2) rad/s about the shank's own medio-lateral axis; positive: the ankle swings forward
    ankle: Array  # (3, n, 2) m, ankle centre in the heading frame
    knee: Array  # (3, n, 2) m, knee centre in the heading frame


def _turn(vectors: Array, axis: int, cosine: Array, sine: Array) -> None:
    """Rotate vectors (3, n, 2, m) in place about a coordinate axis."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    first = cosine * vectors[i] - sine * vectors[j]
    vectors[j] = sine * vectors[i] + cosine * vectors[j]
    vectors[i] = first


def leg_motion(position: Array, velocity: Array, body: Anthropometry) -> LegMotion:
    """Forward kinematics of both legs.

    position (n, 15) rad and velocity (n, 15) rad/s in the order of LOWER_BODY. Each segment's vectors are carried
    from the shank up to the heading frame. The shank's rate about its own z axis u is the sum over the joints of
    u . e_k dq_k, where e_k is the joint's axis, the same before and after the joint's own rotation, and u is
    written in that joint's frame on the way up.
    """
    signed = position * _SIGN
    cosine, sine, rate = np.cos(signed), np.sin(signed), velocity * _SIGN
    vectors = np.zeros((3, len(position), 2, 3))  # last index: shank axis u, ankle, knee
    axis_u, ankle, knee = vectors[..., 0], vectors[..., 1], vectors[..., 2]
    axis_u[2] = 1.0
    shank_rate = np.zeros((len(position), 2))

    def climb(columns: NDArray[np.int64]) -> None:
        for pair in columns[::-1]:
            axis = _AXIS[pair[0]]
            shank_rate[:] += rate[:, pair] * axis_u[axis]
            _turn(vectors, axis, cosine[:, pair, None], sine[:, pair, None])

    ankle[1] -= body.shank_length_m
    climb(_KNEE_COLUMNS)
    ankle[1] -= body.thigh_length_m
    knee[1] -= body.thigh_length_m
    climb(_HIP_COLUMNS)
    half_width = np.array([-0.5, 0.5]) * body.hip_width_m
    ankle[2] += half_width
    knee[2] += half_width
    climb(_LEVEL_COLUMNS)
    shank_rate += rate[:, [_HEADING_COLUMN]] * axis_u[_AXIS[_HEADING_COLUMN]]
    return LegMotion(shank_rate, ankle, knee)
