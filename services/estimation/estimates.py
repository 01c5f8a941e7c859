"""Rows as messages."""

from schemas.kinematics import JointState
from schemas.rhythm import Rhythm
from schemas.signals import JOINT_STATE, RHYTHM, SIGNALS
from schemas.vocabulary import Segment
from services.estimation.rows import MODEL, Row
from services.flow.message import Output

OUTPUTS = tuple(signal for signal in SIGNALS if signal.producer == "estimation")
"""Of every node, also of one that never sends some of them: readers wait for the end of each stream."""


def estimates(rows: list[Row], valid: list[bool], observed: list[Segment], model: str = MODEL) -> list[Output]:
    """Joint states and rhythm: one message each for some rows."""
    newest_ns = rows[-1].captured_ns
    joints = _joint_state(rows, valid, observed, model)
    return [Output(JOINT_STATE, newest_ns, joints), Output(RHYTHM, newest_ns, _rhythm(rows))]


def _joint_state(rows: list[Row], valid: list[bool], observed: list[Segment], model: str) -> JointState:
    return JointState(
        model=model,
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
