import json
import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from schemas.gait import GaitEvent, Stride
from schemas.health import Reason
from schemas.kinematics import JointState
from schemas.rhythm import Rhythm
from schemas.vocabulary import LOWER_BODY, GaitEventKind, Side
from services.bench.gait.joint_walks import JOINTS, RHYTHMS, JointTrack, joint_walk
from services.flow.message import Envelope, Message
from services.segmentation.node import SegmentationNode, build

WALK = "speed=1.1&seed=3&duration=20"
DOFS = len(LOWER_BODY)


def run(messages, node=None) -> list:
    node = node or build(joint_walk(WALK).description)
    return [output for message in messages for output in node.step(message)] + node.finish()


def plain(outputs) -> list[tuple[str, int, str]]:
    return [(output.signal.name, output.captured_ns, output.payload.model_dump_json()) for output in outputs]


def strides(outputs) -> list[Stride]:
    return [output.payload for output in outputs if isinstance(output.payload, Stride)]


def events(outputs) -> list[GaitEvent]:
    return [output.payload for output in outputs if isinstance(output.payload, GaitEvent)]


@pytest.fixture(scope="module")
def messages() -> list[Message]:
    return joint_walk(WALK).track.messages()


@pytest.fixture(scope="module")
def expected(messages) -> list:
    return plain(run(messages))


@pytest.mark.parametrize("side", list(Side))
def test_every_contact_is_found(side, messages):
    true = joint_walk(WALK).contacts_s(side)
    found = [
        event.captured_ns * 1e-9
        for event in events(run(messages))
        if event.side is side and event.kind is GaitEventKind.INITIAL_CONTACT
    ]
    assert abs(len(found) - len(true)) <= 1
    errors = [min(abs(np.array(found) - at)) for at in true[1:-1]]
    assert max(errors) < 0.06


@pytest.mark.parametrize("ticks", [1, 2, 7])
def test_batches_do_not_matter(ticks, expected):
    assert plain(run(joint_walk(WALK).track.messages(ticks))) == expected


@pytest.mark.parametrize("seed", range(4))
def test_the_order_of_the_two_streams_does_not_matter(seed, messages, expected):
    rng = random.Random(seed)
    joints = [message for message in messages if message.stream == JOINTS]
    rhythms = [message for message in messages if message.stream == RHYTHMS]
    merged = []
    while joints or rhythms:
        source = joints if not rhythms or (joints and rng.random() < 0.5) else rhythms
        merged += source[:20]
        del source[:20]
    assert plain(run(merged)) == expected


@pytest.mark.parametrize("cut", [1, 100, 333, 501])
def test_split_and_resume(cut, messages, expected):
    first, second = build(joint_walk(WALK).description), build(joint_walk(WALK).description)
    outputs = [output for message in messages[:cut] for output in first.step(message)]
    second.restore(json.loads(json.dumps(first.snapshot())))
    assert second.snapshot() == first.snapshot()
    assert plain(outputs + run(messages[cut:], second)) == expected


def test_two_sessions_interleaved_are_each_alone(messages, expected):
    other = joint_walk("speed=0.7&seed=5&duration=20&asymmetry=0.3")
    nodes = build(joint_walk(WALK).description), build(other.description)
    outputs: tuple[list, list] = ([], [])
    for pair in zip(messages, other.track.messages(), strict=True):
        for node, message, output in zip(nodes, pair, outputs, strict=True):
            output += node.step(message)
    for node, output in zip(nodes, outputs, strict=True):
        output += node.finish()
    assert plain(outputs[0]) == expected
    assert plain(outputs[1]) == plain(run(other.track.messages(), build(other.description)))


def test_curves_are_those_of_the_walk(messages):
    track = joint_walk(WALK).track
    stride = strides(run(messages))[6]
    at = np.linspace(stride.start_ns, stride.end_ns, 101) * 1e-9
    for i, dof in enumerate(LOWER_BODY):
        expected = np.interp(at, track.time_s, track.position[:, i])
        np.testing.assert_allclose(stride.curves[dof.name].position, expected, atol=1e-6)


def test_only_valid_coordinates_have_curves():
    valid = tuple(dof.name != "knee_adduction_left" for dof in LOWER_BODY)
    found = strides(run(joint_walk(WALK).track.messages(valid=valid)))
    assert found
    assert all("knee_adduction_left" not in stride.curves and len(stride.curves) == DOFS - 1 for stride in found)


def message_of(number: int, **changes) -> Message:
    rows = [[0.0] * DOFS]
    fields = {
        "model": "lower_body",
        "captured_ns": [number * 10_000_000],
        "position": rows,
        "velocity": rows,
        "acceleration": rows,
        "position_std": rows,
        "velocity_std": rows,
        "valid": [True] * DOFS,
        "observed": [],
    }
    return Message(JOINTS, Envelope(0, number, number), JointState.model_construct(**(fields | changes)))


def rhythm_of(number: int, **changes) -> Message:
    fields = {"captured_ns": [number * 10_000_000], "phase": [0.0], "frequency": [1.0], "quality": [1.0]}
    return Message(
        RHYTHMS, Envelope(0, number, number), Rhythm.model_construct(**(fields | {"locked": [True]} | changes))
    )


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"position": [[0.0] * 3]}, Reason.WRONG_SHAPE),
        ({"position_std": []}, Reason.WRONG_SHAPE),
        ({"valid": [True]}, Reason.WRONG_SHAPE),
        ({"model": "octopus"}, Reason.WRONG_SHAPE),
        ({"captured_ns": [10_000_000]}, Reason.CLOCK_BACKWARDS),
        ({"captured_ns": [10**30]}, Reason.OUT_OF_RANGE),
        ({"position": [[float("nan")] * DOFS]}, Reason.OUT_OF_RANGE),
        ({"position": [[1e300] * DOFS]}, Reason.OUT_OF_RANGE),
        ({"velocity": [[float("inf")] * DOFS]}, Reason.OUT_OF_RANGE),
        ({"position_std": [[float("nan")] * DOFS]}, Reason.OUT_OF_RANGE),
    ],
)
def test_what_cannot_be_used_is_counted(changes, reason):
    node = build(joint_walk(WALK).description)
    bad = message_of(2, **changes)
    for message in (message_of(1), rhythm_of(1), bad, rhythm_of(2, captured_ns=bad.payload.captured_ns)):
        assert node.step(message) == []
    assert node.finish() == []
    [rejection] = node.rejections()
    assert (rejection.subject, rejection.reason, rejection.count) == ("joint_state/estimation", reason, 1)


def test_a_rhythm_of_another_shape_is_counted_and_the_joints_used():
    node = build(joint_walk(WALK).description)
    node.step(message_of(1))
    node.step(rhythm_of(1, phase=[]))
    [rejection] = node.rejections()
    assert (rejection.subject, rejection.reason) == ("rhythm/estimation", Reason.WRONG_SHAPE)


def test_no_samples_no_harm():
    node = build(joint_walk(WALK).description)
    empty = message_of(1, captured_ns=[], position=[], velocity=[], position_std=[])
    assert node.step(empty) == []
    assert node.finish() == []


motion = st.lists(
    st.tuples(st.integers(1, 400), st.floats(-4, 4), st.floats(-30, 30), st.floats(-50, 50), st.booleans()), max_size=60
)


@settings(max_examples=40, deadline=None)
@given(motion)
def test_any_motion_is_survived(samples):
    node = SegmentationNode(joint_walk(WALK).description)
    now, outputs = 0, []
    for ticks, angle, rate, phase, seen in samples:
        now += ticks * 5_000_000
        rows = {"position": [[angle] * DOFS], "velocity": [[rate, -rate, rate] * 5], "valid": [seen] * DOFS}
        outputs += node.step(message_of(1, captured_ns=[now], **rows))
        outputs += node.step(rhythm_of(1, captured_ns=[now], phase=[phase]))
    for output in outputs + node.finish():
        type(output.payload).model_validate_json(output.payload.model_dump_json())
    json.dumps(node.snapshot(), allow_nan=False)


def test_a_constant_posture_has_no_events():
    track = JointTrack(np.arange(2000) / 100, np.full((2000, DOFS), 0.2), np.zeros((2000, DOFS)), np.arange(2000.0))
    assert run(track.messages()) == []
