"""The picture of a knee session: bones of the worn legs alone, the lower ankle on the floor."""

import math
from collections.abc import Sequence

import numpy as np

from schemas.kinematics import LivePose, SegmentPose, SensorStatus
from schemas.vocabulary import LOWER_BODY, Segment
from services.biomech.forward_kinematics import ankle_position, segment_poses
from services.biomech.lower_body import LowerBodyModel
from services.biomech.rotations import quaternion_from_matrix
from services.estimation.knee.worn_legs import WornLeg
from services.estimation.rows import Row


def leg_pictures(
    model: LowerBodyModel, position: Sequence[float], legs: Sequence[WornLeg], unseen: frozenset[Segment]
) -> list[SegmentPose]:
    """Thigh and shank of each worn leg for joint coordinates in the order of LOWER_BODY."""
    poses = segment_poses(model, np.array(position))
    floor = min(float(ankle_position(model, poses, leg.segments[1])[1]) for leg in legs)
    lift = np.array([0.0, -floor, 0.0])
    return [
        SegmentPose(
            segment=segment,
            position=(poses[segment].position + lift).tolist(),
            quat_world_from_segment=quaternion_from_matrix(poses[segment].R_world_from_segment).tolist(),
            valid=segment not in unseen,
        )
        for leg in legs
        for segment in leg.segments
    ]


def knee_pose(
    row: Row, bones: list[SegmentPose], valid: Sequence[bool], message: str, notice: str, statuses: list[SensorStatus]
) -> LivePose:
    """The picture of one row."""
    seen = [(i, dof.name) for i, dof in enumerate(LOWER_BODY) if valid[i]]
    return LivePose(
        captured_ns=row.captured_ns,
        phase="estimating",
        message=message,
        notice=notice,
        segments=bones,
        angles={name: row.position[i] for i, name in seen},
        angles_std={name: row.position_std[i] for i, name in seen},
        sensors=statuses,
        # Two steps a stride.
        cadence_per_min=row.rhythm.frequency / (2.0 * math.pi) * 120.0 if row.rhythm.locked else None,
    )
