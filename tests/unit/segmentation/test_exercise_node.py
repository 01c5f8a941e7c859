"""The node in sessions with a camera: squats, tilts and steps of the whole body, their joint centres beside them."""

import json
import random

import numpy as np
import pytest

from schemas.health import Reason
from schemas.kinematics import JointCentres, JointState
from schemas.rhythm import Rhythm
from schemas.session import CameraDescription
from schemas.signals import JOINT_CENTRES, JOINT_STATE, RHYTHM
from schemas.tasks import Repetition
from schemas.vocabulary import BODY_MODELS, CameraKind, JointCentre, SkeletonJoint, Task
from services.bench.gait.joint_walks import joint_walk
from services.flow.message import Envelope, Message, Stream
from services.segmentation.node import build

NAMES = [dof.name for dof in BODY_MODELS["whole_body"]]
AT = {name: i for i, name in enumerate(NAMES)}
JOINTS, RHYTHMS, CENTRES = (Stream(signal, "estimation") for signal in (JOINT_STATE, RHYTHM, JOINT_CENTRES))
CAMERA = CameraDescription(
    name="camera", kind=CameraKind.KINECT_V2, rate_hz=30, joints=list(SkeletonJoint)[:25], floor_m=None
)


def session(task=Task.SQUAT):
    changes = {"task": task, "cameras": [CAMERA], "hubs": [], "estimator": "body_cekf"}
    return joint_walk("duration=20").description.model_copy(update=changes)


def squats(times=4, depth=1.4, seed=0, rows=1):
    """Messages of all three streams, message for message."""
    rng = np.random.default_rng(seed)
    down = 0.5 - 0.5 * np.cos(np.linspace(0, 2 * np.pi, 75))
    course = np.concatenate([np.zeros(60), *[np.concatenate([down, np.zeros(12)])] * times, np.zeros(45)])
    position = np.zeros((len(course), len(NAMES)))
    position[:, AT["knee_flexion_right"]] = depth * course
    position[:, AT["knee_flexion_left"]] = 0.9 * depth * course
    position += rng.normal(0, 0.01, position.shape)
    velocity = np.gradient(position, 1 / 30, axis=0)
    centres = rng.normal(0, 0.01, (len(course), 15, 3)) + np.arange(45).reshape(15, 3) / 30
    messages = []
    for number, start in enumerate(range(0, len(course), rows)):
        part = slice(start, start + rows)
        ns = [round((start + i) * 1e9 / 30) for i in range(len(course[part]))]
        n = len(ns)
        envelope = Envelope(0, number, ns[-1])
        joints = JointState(
            model="whole_body", captured_ns=ns, position=position[part].tolist(), velocity=velocity[part].tolist(),
            acceleration=[[0.0] * len(NAMES)] * n, position_std=[[0.03] * len(NAMES)] * n,
            velocity_std=[[0.1] * len(NAMES)] * n, valid=[True] * len(NAMES), observed=[],
        )  # fmt: skip
        rhythm = Rhythm(captured_ns=ns, phase=[0.0] * n, frequency=[0.0] * n, quality=[0.0] * n, locked=[False] * n)
        seen = JointCentres(captured_ns=ns, position=centres[part].tolist(), seen=[True] * len(JointCentre))
        messages += [Message(JOINTS, envelope, joints), Message(RHYTHMS, envelope, rhythm)]
        messages.append(Message(CENTRES, envelope, seen))
    return messages


def run(messages, node=None):
    node = node or build(session())
    return [output for message in messages for output in node.step(message)] + node.finish()


def plain(outputs):
    return [(output.signal.name, output.captured_ns, output.payload.model_dump_json()) for output in outputs]


@pytest.fixture(scope="module")
def messages():
    return squats()


@pytest.fixture(scope="module")
def expected(messages):
    return plain(run(messages))


def test_squats_come_out_with_the_ranges_of_the_whole_body(messages):
    node = build(session())
    assert set(node.streams) == {JOINTS, RHYTHMS, CENTRES}
    found = [output.payload for output in run(messages, node)]
    assert all(isinstance(one, Repetition) and one.valid for one in found)
    assert len(found) == 4
    assert set(found[0].ranges) == {*NAMES, "arm_elevation_left", "arm_elevation_right"}
    assert found[0].ranges["knee_flexion_left"] == pytest.approx(1.26, abs=0.06)
    assert node.rejections() == []


@pytest.mark.parametrize("rows", [2, 7])
def test_batches_do_not_matter(rows, expected):
    assert plain(run(squats(rows=rows))) == expected


@pytest.mark.parametrize("seed", range(3))
def test_the_order_of_the_streams_does_not_matter(seed, messages, expected):
    rng = random.Random(seed)
    streams = [[m for m in messages if m.stream == stream] for stream in (JOINTS, RHYTHMS, CENTRES)]
    merged = []
    while any(streams):
        source = rng.choice([stream for stream in streams if stream])
        merged += source[:15]
        del source[:15]
    assert plain(run(merged)) == expected


@pytest.mark.parametrize("cut", [1, 200, 500, 700, 1100])
def test_split_and_resume(cut, messages, expected):
    first, second = build(session()), build(session())
    outputs = [output for message in messages[:cut] for output in first.step(message)]
    second.restore(json.loads(json.dumps(first.snapshot(), allow_nan=False)))
    assert second.snapshot() == first.snapshot()
    assert plain(outputs + run(messages[cut:], second)) == expected


def test_two_sessions_interleaved_are_each_alone(messages, expected):
    other = squats(depth=0.9, seed=3)
    nodes, outputs = (build(session()), build(session())), ([], [])
    for pair in zip(messages, other, strict=True):
        for node, message, output in zip(nodes, pair, outputs, strict=True):
            output += node.step(message)
    for node, output in zip(nodes, outputs, strict=True):
        output += node.finish()
    assert plain(outputs[0]) == expected
    assert plain(outputs[1]) == plain(run(other))


def test_without_centres_arms_have_no_range_and_squats_count(messages):
    found = [output.payload for output in run([m for m in messages if m.stream != CENTRES])]
    assert [one.valid for one in found] == [True] * 4
    assert "arm_elevation_left" not in found[0].ranges


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"position": [[[0.0] * 3] * 14]}, Reason.WRONG_SHAPE),
        ({"seen": [True]}, Reason.WRONG_SHAPE),
        ({"position": [[[float("nan")] * 3] * 15]}, Reason.OUT_OF_RANGE),
        ({"position": [[[1e6] * 3] * 15]}, Reason.OUT_OF_RANGE),
    ],
)
def test_centres_that_cannot_be_used_are_counted_and_the_joints_used(changes, reason, messages):
    bad = messages[2].payload.model_dump() | changes
    node = build(session())
    for message in messages[:2]:
        node.step(message)
    node.step(Message(CENTRES, messages[2].envelope, JointCentres.model_construct(**bad)))
    [rejection] = node.rejections()
    assert (rejection.subject, rejection.reason, rejection.count) == ("joint_centres/estimation", reason, 1)


def test_another_model_in_mid_session_is_counted(messages):
    node = build(session())
    for message in messages[:3]:
        node.step(message)
    lower = joint_walk("duration=20").track.messages()[50]
    node.step(lower)
    node.finish()
    assert [(each.subject, each.reason) for each in node.rejections()] == [
        ("joint_state/estimation", Reason.WRONG_SHAPE)
    ]
