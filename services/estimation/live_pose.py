"""The picture for a screen: when it is due, the bones, the angles, and what stands there before there are any."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.kinematics import CameraStatus, LivePose, SegmentPose, SensorStatus
from schemas.vocabulary import BODY_MODELS, JointCentre, Segment
from services.biomech.forward_kinematics import ankle_position, segment_poses
from services.biomech.lower_body import LowerBodyModel
from services.biomech.rotations import quaternion_from_matrix
from services.estimation.rows import MODEL, Row

Array = NDArray[np.float64]
SHANKS = (Segment.SHANK_RIGHT, Segment.SHANK_LEFT)


class Pace:
    """Of pictures, by the time of the data."""

    def __init__(self, rate_hz: float) -> None:
        self._period_ns = round(1e9 / rate_hz)
        self.next_ns = 0

    def is_due(self, captured_ns: int) -> bool:
        """Whether a picture at this time is the next one; if so, the one after it is a period later."""
        if captured_ns < self.next_ns:
            return False
        self.next_ns = (captured_ns // self._period_ns + 1) * self._period_ns
        return True


def segment_pictures(
    model: LowerBodyModel, position: Array, segments: Sequence[Segment], unseen: frozenset[Segment]
) -> list[SegmentPose]:
    """Bones for joint coordinates (n,) of the model; the lower ankle of those drawn stands on the floor."""
    poses = segment_poses(model, position)
    floor = min(float(ankle_position(model, poses, shank)[1]) for shank in SHANKS if shank in segments)
    lift = np.array([0.0, -floor, 0.0])
    return [
        SegmentPose(
            segment=segment,
            position=(poses[segment].position + lift).tolist(),
            quat_world_from_segment=quaternion_from_matrix(poses[segment].R_world_from_segment).tolist(),
            valid=segment not in unseen,
        )
        for segment in segments
    ]


class Watched(NamedTuple):
    """What cameras add to a picture."""

    centres: dict[JointCentre, list[float]]  # m, room; empty while nobody is in view
    cameras: list[CameraStatus]


NO_CAMERA = Watched({}, [])


def waiting_pose(
    captured_ns: int, phase: str, message: str, notice: str, statuses: list[SensorStatus], watched: Watched = NO_CAMERA
) -> LivePose:
    """The picture before there is an estimate."""
    return LivePose(
        captured_ns=captured_ns,
        phase=phase,
        message=message,
        notice=notice,
        segments=[],
        angles={},
        angles_std={},
        sensors=statuses,
        centres=watched.centres,
        cameras=watched.cameras,
        cadence_per_min=None,
    )


def estimated_pose(
    row: Row, bones: list[SegmentPose], valid: Sequence[bool], message: str, notice: str,
    statuses: list[SensorStatus], watched: Watched = NO_CAMERA, model: str = MODEL,
) -> LivePose:  # fmt: skip
    """The picture of one row of a body model."""
    seen = [(i, dof.name) for i, dof in enumerate(BODY_MODELS[model]) if valid[i]]
    return LivePose(
        captured_ns=row.captured_ns,
        phase="estimating",
        message=message,
        notice=notice,
        segments=bones,
        angles={name: row.position[i] for i, name in seen},
        angles_std={name: row.position_std[i] for i, name in seen},
        sensors=statuses,
        centres=watched.centres,
        cameras=watched.cameras,
        # Two steps a stride.
        cadence_per_min=row.rhythm.frequency / (2.0 * math.pi) * 120.0 if row.rhythm.locked else None,
    )
