"""A session with a camera: what it says from the first frame on, and that nothing but captured time decides."""

import json
from functools import cache

import numpy as np
import pytest

from schemas.vocabulary import CAMERA_ESTIMATORS, LOWER_BODY_ESTIMATORS, SensorState, SkeletonJoint
from services.biomech.whole_body.model import CENTRE_NAMES
from services.biomech.whole_body.parameters import LIMITS_DEG, per_angle
from services.estimation.body.node import BodyNode
from services.estimation.node import build
from services.estimation.refusal import RefusingNode
from tests.unit.estimation.body import body_sessions as sessions

KNEES = [sessions.NAMES.index(f"knee_flexion_{side}") for side in ("right", "left")]


@cache
def exercise() -> np.ndarray:
    """2 s of standing, then squats."""
    return np.concatenate([sessions.standing(2.0), sessions.squats(9.0)])


@cache
def undisturbed():
    return tuple(sessions.run(sessions.node(), sessions.messages(sessions.seen(exercise()))))


def test_every_frame_leads_to_a_row_and_to_joint_centres():
    times, _, _ = sessions.table(undisturbed())
    assert times.tolist() == [sessions.time_ns(k) for k in range(len(exercise()))]
    centres = sessions.centres(undisturbed())
    assert [t for each in centres for t in each.captured_ns] == times.tolist()
    assert [o.captured_ns for o in undisturbed() if o.signal.name == "rhythm"] == [c.captured_ns[-1] for c in centres]
    assert all(all(each.seen) for each in centres)


def test_the_angles_are_right():
    _, position, valid = sessions.table(undisturbed())
    error = np.degrees(position[:, KNEES] - exercise()[:, [3 + i for i in KNEES]])
    assert valid[:, KNEES].all()
    assert np.sqrt(np.mean(error**2)) < 3.0
    found = np.concatenate([each.position for each in sessions.centres(undisturbed())])
    truth = sessions.seen(exercise(), std=0.0)
    assert np.sqrt(np.mean(np.sum((found - truth) ** 2, axis=2))) < 0.03


def test_only_what_centres_show_is_valid():
    _, position, valid = sessions.table(undisturbed())
    names = sessions.NAMES
    assert not valid[:, names.index("clavicle_elevation_right")].any()
    rotation = valid[:, names.index("hip_internal_rotation_right")]
    assert rotation.any()
    assert position[rotation][:, KNEES[0]].min() > np.radians(20.0)


def test_the_calibration_says_that_the_person_stood():
    calibration, held = sessions.calibrations(undisturbed())
    assert (calibration.model, calibration.absolute, calibration.method) == ("whole_body", True, "standing")
    assert calibration.lengths["thigh_right"] == pytest.approx(0.245 * sessions.STATURE, rel=0.05)
    assert len(calibration.lengths) == 12
    assert 0.4 < calibration.quality <= 1.0
    assert (held.absolute, held.datum) == (True, calibration.datum)
    assert held.lengths != calibration.lengths


def test_the_page_asks_to_stand_and_then_shows_the_body():
    poses = sessions.pictures(undisturbed())
    assert poses[0].phase == "calibrating"
    assert "Stand still" in poses[0].message
    assert list(poses[0].centres) == list(CENTRE_NAMES)
    last = poses[-1]
    assert (last.phase, last.message, last.segments) == ("estimating", "", [])
    assert [(c.camera, c.state, c.people) for c in last.cameras] == [(sessions.CAMERA, SensorState.OK, 1)]
    assert "knee_flexion_right" in last.angles
    assert last.angles.keys() == last.angles_std.keys()


def test_nothing_leaves_the_limits_and_everything_is_finite():
    low, high = per_angle(LIMITS_DEG).T
    for quantity in ("position", "velocity", "acceleration", "position_std", "velocity_std"):
        assert np.isfinite(sessions.table(undisturbed(), quantity)[1]).all()
    angles = sessions.table(undisturbed())[1][:, 1:22]
    assert (angles >= low[1:]).all()
    assert (angles <= high[1:]).all()


@pytest.mark.parametrize("estimator", list(CAMERA_ESTIMATORS))
def test_split_and_resume_is_identical(estimator):
    description = sessions.describe(estimator)
    # The printed filter is slow, and begins anew whenever it has diverged.
    stream = sessions.messages(sessions.seen(exercise()[: 150 if estimator == "body_cekf" else 40]), frames=2)
    whole = sessions.text(sessions.run(BodyNode(description), stream))
    assert any("joint_state" in each for each in whole)
    for split in (7, 16, len(stream) - 2):
        first, second = BodyNode(description), BodyNode(description)
        outputs = [output for message in stream[:split] for output in first.step(message)]
        second.restore(json.loads(json.dumps(first.snapshot(), allow_nan=False)))
        assert sessions.text(outputs + sessions.run(second, stream[split:])) == whole
        assert second.rejections() == first.rejections()


def test_batching_decides_nothing():
    centres = sessions.seen(exercise()[:150])
    one, five = (sessions.run(sessions.node(), sessions.messages(centres, frames=n)) for n in (1, 5))
    for quantity in ("position", "velocity_std"):
        for a, b in zip(sessions.table(one, quantity), sessions.table(five, quantity), strict=True):
            assert (a == b).all()
    assert sessions.calibrations(one) == sessions.calibrations(five)


def test_two_sessions_interleaved_equal_each_alone():
    streams = [sessions.messages(sessions.seen(exercise()[:120], seed)) for seed in (0, 1)]
    alone = [sessions.text(sessions.run(sessions.node(), stream)) for stream in streams]
    nodes, mixed = [sessions.node(), sessions.node()], [[], []]
    for pair in zip(*streams, strict=True):
        for i, message in enumerate(pair):
            mixed[i] += nodes[i].step(message)
    assert [sessions.text(mixed[i] + nodes[i].finish()) for i in (0, 1)] == alone


def test_without_a_camera_or_its_joints_the_page_says_why():
    node = build(sessions.describe(cameras=()))
    assert isinstance(node, RefusingNode)
    assert "needs a depth camera" in node.reason
    without_spine = [joint for joint in sessions.JOINTS if joint is not SkeletonJoint.SPINE_MID]
    node = build(sessions.describe(joints=without_spine))
    assert isinstance(node, RefusingNode)
    assert "spine mid" in node.reason


@pytest.mark.parametrize("estimator", [*list(LOWER_BODY_ESTIMATORS)[:1], "knee_axis", "fusion"])
def test_an_estimator_of_sensors_on_a_camera_alone_is_refused(estimator):
    node = build(sessions.describe(estimator))
    assert isinstance(node, RefusingNode)
    (pose,) = node.step(sessions.messages(sessions.seen(sessions.standing(0.1)))[0])
    assert "choose" in pose.payload.message


def test_a_second_camera_is_not_used():
    description = sessions.describe(cameras=(sessions.CAMERA, "second"))
    node = BodyNode(description)
    assert [stream.source for stream in node.streams] == [sessions.CAMERA]
    outputs = sessions.run(node, sessions.messages(sessions.seen(sessions.standing(1.5))))
    assert sessions.calibrations(outputs)[0].unused == {"second": "the first camera is used"}
    assert {c.camera: c.state for c in sessions.pictures(outputs)[-1].cameras}["second"] is SensorState.UNUSED


def test_ankles_are_told_while_the_feet_are_on_the_floor():
    """A squat whose ankles stay: the shank's inclination is pelvis tilt + knee flexion - hip flexion."""
    q = exercise().copy()
    rest = sessions.seen(q[:1], std=0.0)[0]
    centres = sessions.seen(q, std=0.0)
    feet = centres[:, [11, 14]].mean(axis=1)
    q[:, :3] += rest[[11, 14]].mean(axis=0) - feet
    outputs = sessions.run(sessions.node(), sessions.messages(sessions.seen(q, 5)))
    _, position, valid = sessions.table(outputs)
    ankles = [sessions.NAMES.index(f"ankle_dorsiflexion_{side}") for side in ("right", "left")]
    assert valid[:, ankles].mean() > 0.95
    names = ("pelvis_tilt", "knee_flexion_right", "hip_flexion_right")
    tilt, knee, hip = (q[:, 3 + sessions.NAMES.index(name)] for name in names)
    shown = valid[:, ankles[0]]
    error = np.degrees(position[:, ankles[0]] - (tilt + knee - hip))[shown]
    assert np.sqrt(np.mean(error**2)) < 4.0
    stepping = sessions.standing(5.0)
    stepping[60:, 3 + sessions.NAMES.index("hip_flexion_right")] += 1.0
    stepping[60:, 3 + sessions.NAMES.index("knee_flexion_right")] += 1.0
    _, _, valid = sessions.table(sessions.run(sessions.node(), sessions.messages(sessions.seen(stepping, 5))))
    assert valid[75:, ankles].any(axis=0).tolist() == [False, True]
