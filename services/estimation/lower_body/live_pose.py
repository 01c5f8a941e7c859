"""The picture for a screen: bones, angles, sensors, and what the therapist should do."""

import math

import numpy as np
from numpy.typing import NDArray

from schemas.kinematics import LivePose, SegmentPose, SensorStatus
from schemas.vocabulary import LOWER_BODY, Segment
from services.biomech.forward_kinematics import ankle_position, segment_poses
from services.biomech.lower_body import SEGMENTS, LowerBodyModel
from services.biomech.rotations import quaternion_from_matrix
from services.estimation.rows import Row
from services.estimation.sensor_status import sensor_troubles

Array = NDArray[np.float64]


def segment_pictures(model: LowerBodyModel, position: Array, unseen: frozenset[Segment]) -> list[SegmentPose]:
    """Bones for joint coordinates (n,) of the model; the lower ankle stands on the floor."""
    poses = segment_poses(model, position)
    shanks = (Segment.SHANK_RIGHT, Segment.SHANK_LEFT)
    floor = min(float(ankle_position(model, poses, shank)[1]) for shank in shanks)
    lift = np.array([0.0, -floor, 0.0])
    return [
        SegmentPose(
            segment=segment,
            position=(poses[segment].position + lift).tolist(),
            quat_world_from_segment=quaternion_from_matrix(poses[segment].R_world_from_segment).tolist(),
            valid=segment not in unseen,
        )
        for segment in SEGMENTS
    ]


def estimated_pose(
    row: Row, model: LowerBodyModel, position: Array, valid: list[bool], unseen: frozenset[Segment],
    notice: str, statuses: list[SensorStatus],
) -> LivePose:  # fmt: skip
    """The picture of one row; position (n,) in the model's order."""
    seen = [(i, dof.name) for i, dof in enumerate(LOWER_BODY) if valid[i]]
    return LivePose(
        captured_ns=row.captured_ns,
        phase="estimating",
        message=sensor_troubles(statuses),
        notice=notice,
        segments=segment_pictures(model, position, unseen),
        angles={name: row.position[i] for i, name in seen},
        angles_std={name: row.position_std[i] for i, name in seen},
        sensors=statuses,
        # Two steps a stride.
        cadence_per_min=row.rhythm.frequency / (2.0 * math.pi) * 120.0 if row.rhythm.locked else None,
    )
