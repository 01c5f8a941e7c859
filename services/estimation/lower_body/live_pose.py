"""The picture for a screen: bones, angles, sensors, and what the therapist should do."""

import math
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.kinematics import LivePose, SegmentPose, SensorStatus
from schemas.session import SensorDescription
from schemas.vocabulary import LOWER_BODY, Segment, SensorState
from services.biomech.forward_kinematics import ankle_position, segment_poses
from services.biomech.lower_body import SEGMENTS, LowerBodyModel
from services.biomech.rotations import quaternion_from_matrix
from services.estimation.lower_body.lower_body_filter import Row
from services.estimation.sensor_checks import SensorChecks

Array = NDArray[np.float64]

STATE_WORDS = {
    SensorState.MISSING: "sends nothing",
    SensorState.STUCK: "repeats the same values",
    SensorState.REJECTED: "sends values that cannot be used",
    SensorState.CALIBRATING: "came after the calibration: start a new session to use it",
}


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


def sensor_statuses(
    sensors: Sequence[SensorDescription],
    checks: SensorChecks,
    now_ns: int,
    refused: NDArray[np.bool_],
    waiting: NDArray[np.bool_],
) -> list[SensorStatus]:
    """State of each sensor; `refused` (S,) were refused in standing, `waiting` (S,) have no alignment yet."""
    statuses = []
    for s, sensor in enumerate(sensors):
        state, since_ns = checks.state_of(s, now_ns)
        if state is SensorState.OK and refused[s]:
            state = SensorState.REJECTED
        elif state is SensorState.OK and waiting[s]:
            state = SensorState.CALIBRATING
        statuses.append(SensorStatus(sensor=sensor.name, state=state, since_ns=since_ns))
    return statuses


def unused_statuses(unused: Iterable[str]) -> list[SensorStatus]:
    """Sensors, by name, that were never meant to be used with what else is worn."""
    return [SensorStatus(sensor=name, state=SensorState.UNUSED, since_ns=0) for name in unused]


def sensor_troubles(statuses: Sequence[SensorStatus]) -> str:
    """One sentence on what is wrong with the sensors; empty when nothing is."""
    parts = [f"{status.sensor} {STATE_WORDS[status.state]}" for status in statuses if status.state in STATE_WORDS]
    return "Sensor " + ", ".join(parts) if parts else ""


def waiting_pose(captured_ns: int, phase: str, message: str, notice: str, statuses: list[SensorStatus]) -> LivePose:
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
        cadence_per_min=None,
    )


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
