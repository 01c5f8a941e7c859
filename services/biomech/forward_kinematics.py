"""Where the segments are, given the joint coordinates."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import Segment
from services.biomech.bones import SEGMENTS
from services.biomech.kernels.kinematics import place
from services.biomech.lower_body import LowerBodyModel

Array = NDArray[np.float64]


class Pose(NamedTuple):
    """A segment frame in the world."""

    R_world_from_segment: Array  # (3, 3)
    position: Array  # (3,) m, the segment's proximal joint


def segment_poses(model: LowerBodyModel, position: Array) -> dict[Segment, Pose]:
    """Poses of all segments for joint coordinates (n,), in the model's order."""
    n = len(model.dofs)
    rotation, origin = np.empty((n, 3, 3)), np.empty((n, 3))
    place(np.ascontiguousarray(position, dtype=np.float64), model.body, rotation, origin)
    last = {segment: model.last_joint(segment) for segment in SEGMENTS}
    return {segment: Pose(rotation[j], origin[j]) for segment, j in last.items()}


def ankle_position(model: LowerBodyModel, poses: dict[Segment, Pose], shank: Segment) -> Array:
    """Ankle centre in the world, (3,) m."""
    pose = poses[shank]
    down = np.array([0.0, -model.anthropometry.shank_length_m, 0.0])
    return np.asarray(pose.position + pose.R_world_from_segment @ down)
