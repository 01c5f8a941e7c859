"""A camera that is covered, drops frames, guesses, exchanges legs: as asked for, and nothing else."""

import numpy as np
import pytest

from schemas.signals import IMU, SKELETON
from schemas.skeleton import SkeletonBatch
from schemas.standing import StandingMark
from schemas.vocabulary import SkeletonJoint, TrackingState
from services.faults.bursts import BurstModel
from services.faults.camera_faults import (
    BodyRenumbered,
    CameraCovered,
    CameraSilent,
    FrameLoss,
    JointJump,
    JointsInferred,
    LegsExchanged,
)
from services.faults.camera_inject import CameraInjection, inject_camera
from services.flow.message import Envelope, Message, Stream

J = SkeletonJoint
JOINTS = [J.SPINE_BASE, J.HIP_RIGHT, J.KNEE_RIGHT, J.HIP_LEFT, J.KNEE_LEFT, J.HEAD]
TICK = 33_000_000
MARK = StandingMark(from_ns=0, to_ns=TICK, given_ns=TICK)


def stream(frames: int = 90, each: int = 1) -> list[Message]:
    """Three seconds; joint j of frame k is at (k, j, 0); the head is not tracked. A mark in the frame after 1 s."""
    messages = []
    for start in range(0, frames, each):
        ks = range(start, min(start + each, frames))
        batch = SkeletonBatch(
            captured_ns=[k * TICK for k in ks],
            body=[1] * len(ks),
            people=[1] * len(ks),
            position=[[[float(k), float(j), 0.0] for j in range(5)] + [None] for k in ks],
            state=[[TrackingState.TRACKED] * 5 + [TrackingState.NOT_TRACKED] for _ in ks],
            marks=[MARK] if 31 in ks else [],
        )
        messages.append(Message(Stream(SKELETON, "front"), Envelope(0, len(messages), ks[-1] * TICK), batch))
    final = Envelope(0, len(messages), (frames - 1) * TICK, final=True)
    return [*messages, Message(Stream(SKELETON, "front"), final, None)]


def damaged(*faults, each: int = 1):
    return [m.payload for m in inject_camera(stream(each=each), "front", JOINTS, faults) if m.payload]


def frame_of(payloads, k):
    return next(p for p in payloads if p.captured_ns == [k * TICK])


def test_no_fault_changes_nothing():
    assert list(inject_camera(stream(), "front", JOINTS, [])) == stream()


def test_a_covered_camera_sends_frames_with_nobody():
    payloads = damaged(CameraCovered(1.0, 2.0))
    assert len(payloads) == 90
    empty = [k for k, p in enumerate(payloads) if p.body == [None]]
    assert empty == [k for k in range(90) if 1.0 <= k * 0.033 < 2.0]
    assert payloads[40].people == [0]
    assert payloads[40].position == [[None] * 6]
    assert set(payloads[40].state[0]) == {TrackingState.NOT_TRACKED}
    assert payloads[20] == stream()[20].payload


def test_a_silent_camera_leaves_no_hole_in_the_numbering_and_keeps_marks():
    messages = list(inject_camera(stream(), "front", JOINTS, [CameraSilent(0.99, 2.0)]))
    assert [m.envelope.sequence for m in messages] == list(range(len(messages)))
    assert len(messages) == 91 - 31
    assert messages[-1].envelope.final
    assert [(m.payload.captured_ns[0], m.payload.marks) for m in messages if m.payload and m.payload.marks] == [
        (61 * TICK, [MARK])
    ]


def test_every_frame_is_delivered_or_listed_as_lost():
    injection = CameraInjection("front", JOINTS, [FrameLoss(BurstModel().losing(0.3), 5), CameraSilent(2.0, 2.2)])
    left = [p.payload.captured_ns[0] for p in injection.apply(stream()) if p.payload]
    assert injection.sent == 90
    assert sorted([*left, *injection.lost]) == [k * TICK for k in range(90)]
    assert 10 < len(injection.lost) < 60


def test_hidden_joints_are_guessed_where_they_were():
    payloads = damaged(JointsInferred((J.KNEE_LEFT, J.HEAD), 0.99, 2.0, noise_m=0.04, seed=1))
    knee = np.array([p.position[0][4] for p in payloads[30:61]])
    assert {p.state[0][4] for p in payloads[30:61]} == {TrackingState.INFERRED}
    assert np.abs(knee - [29.0, 4.0, 0.0]).max() < 0.2
    assert knee.std() > 0.01
    # What the camera did not see before it does not guess.
    assert {p.state[0][5] for p in payloads} == {TrackingState.NOT_TRACKED}
    assert payloads[70] == stream()[70].payload
    assert payloads[40].position[0][2] == [40.0, 2.0, 0.0]


def test_exchanged_legs_are_not_flagged():
    payloads = damaged(LegsExchanged(1.0, 1.1))
    assert [at[1] if at else None for at in payloads[31].position[0]] == [0.0, 3.0, 4.0, 1.0, 2.0, None]
    assert payloads[31].state == stream()[31].payload.state
    assert payloads[34] == stream()[34].payload


def test_a_jump_is_one_frame_and_tracked():
    payloads = damaged(JointJump(J.HIP_RIGHT, 0.5, (0.0, 0.4, 0.0)))
    assert [k for k, p in enumerate(payloads) if p.position[0][1][1] != 1.0] == [16]
    assert payloads[16].state[0][1] == TrackingState.TRACKED


def test_another_body_has_another_number_from_then_on():
    payloads = damaged(CameraCovered(1.0, 1.5), BodyRenumbered(1.2))
    assert [payloads[k].body[0] for k in (0, 30, 31, 45, 46, 89)] == [1, 1, None, None, 2, 2]


@pytest.mark.parametrize("each", [2, 7, 40])
def test_batches_make_no_difference(each):
    faults = [
        FrameLoss(BurstModel().losing(0.2), 3), CameraCovered(0.5, 0.7), JointsInferred((J.KNEE_RIGHT,), 1.0, 1.5),
        LegsExchanged(1.2, 1.4), JointJump(J.HIP_LEFT, 2.0, (1.0, 0.0, 0.0)), BodyRenumbered(2.5),
    ]  # fmt: skip
    single, joined = damaged(*faults), damaged(*faults, each=each)
    for field in ("captured_ns", "body", "people", "position", "state", "marks"):
        assert [row for p in joined for row in getattr(p, field)] == [row for p in single for row in getattr(p, field)]


def test_other_cameras_and_sensors_are_left_alone():
    beside = [Message(Stream(SKELETON, "side"), message.envelope, message.payload) for message in stream()] + [
        Message(Stream(IMU, "hub"), Envelope(0, 0, 0, final=True), None)
    ]
    assert list(inject_camera(beside, "front", JOINTS, [CameraSilent(0.0, 9.0)])) == beside
