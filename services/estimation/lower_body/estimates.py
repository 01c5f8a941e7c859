"""Rows of the filter as messages."""

from schemas.kinematics import JointState
from schemas.rhythm import Rhythm
from schemas.signals import JOINT_STATE, RHYTHM, SEGMENT_MOTION
from schemas.vocabulary import Segment
from services.estimation.lower_body.calibration_message import MODEL
from services.estimation.lower_body.lower_body_filter import Row
from services.estimation.lower_body.segment_motion import LoneSegments
from services.flow.message import Output


def estimates(rows: list[Row], valid: list[bool], observed: list[Segment], lone: LoneSegments | None) -> list[Output]:
    """Joint states, rhythm and, where lone segments are followed, their motion: one message each for some rows."""
    newest_ns = rows[-1].captured_ns
    joints = _joint_state(rows, valid, observed)
    outputs = [Output(JOINT_STATE, newest_ns, joints), Output(RHYTHM, newest_ns, _rhythm(rows))]
    if lone is not None:
        outputs.append(Output(SEGMENT_MOTION, newest_ns, lone.collect(joints.captured_ns)))
    return outputs


def _joint_state(rows: list[Row], valid: list[bool], observed: list[Segment]) -> JointState:
    return JointState(
        model=MODEL,
        captured_ns=[row.captured_ns for row in rows],
        position=[row.position for row in rows],
        velocity=[row.velocity for row in rows],
        acceleration=[row.acceleration for row in rows],
        position_std=[row.position_std for row in rows],
        velocity_std=[row.velocity_std for row in rows],
        valid=valid,
        observed=observed,
    )


def _rhythm(rows: list[Row]) -> Rhythm:
    return Rhythm(
        captured_ns=[row.captured_ns for row in rows],
        phase=[row.rhythm.phase for row in rows],
        frequency=[row.rhythm.frequency for row in rows],
        quality=[row.rhythm.quality for row in rows],
        locked=[row.rhythm.locked for row in rows],
    )
