import json
import math
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from schemas.health import Reason
from schemas.imu import ImuBatch
from schemas.session import StandingInterval
from schemas.vocabulary import LOWER_BODY_ESTIMATORS, Segment, SensorState
from services.biomech.rotations import angle_between, matrix_from_quaternion
from services.estimation.lower_body.node import LowerBodyNode
from services.flow.message import Message

sys.path.insert(0, str(Path(__file__).parent))
from tests.unit.estimation import estimation_walks as walks

SHANK_LEFT = walks.SEGMENTS.index(Segment.SHANK_LEFT)


@pytest.fixture(scope="module")
def undisturbed():
    return walks.run(LowerBodyNode(walks.describe()), walks.messages(walks.describe(), walks.walk()[1]))


def test_every_message_of_the_walk_gives_one_joint_state_and_one_rhythm(undisturbed) -> None:
    states, rhythms = walks.joint_states(undisturbed), walks.rhythms(undisturbed)
    times = [captured_ns for state in states for captured_ns in state.captured_ns]
    assert times == list(range(times[0], 9_000_000_000, 10_000_000))
    assert times[0] <= walks.STANDING_S * 1e9, "nothing of the walk is lost"
    assert [rhythm.captured_ns for rhythm in rhythms] == [state.captured_ns for state in states]


def test_calibration_finds_the_mounting(undisturbed) -> None:
    (calibration,) = walks.calibrations(undisturbed)
    assert calibration.quality > 0.6
    for k, sensor in enumerate(calibration.sensors):
        R = matrix_from_quaternion(np.array(sensor.quat_segment_from_sensor))
        truth = walks.mounting()[sensor.segment]
        for axis in range(3):
            assert angle_between(R[axis], truth[axis]) < math.radians(6)
        np.testing.assert_allclose(sensor.gyro_bias, walks.gyro_bias()[k], atol=5e-3)


@pytest.mark.parametrize("name", ["knee_flexion_left", "knee_flexion_right", "hip_flexion_left", "hip_flexion_right"])
def test_angles_follow_the_body(undisturbed, name: str) -> None:
    """The pelvis does not travel in this walk, so the gravity model errs by a few degrees; signs cannot hide in it."""
    truth = walks.walk()[0][:, walks.NAMES.index(name)]
    estimate = walks.angles(undisturbed, name)
    error = np.array([estimate[k * 10_000_000] - truth[k] for k in range(300, 900)])
    assert np.degrees(np.std(error)) < 4.0
    assert abs(np.degrees(np.mean(error))) < 4.0
    assert np.corrcoef(truth[300:900], [estimate[k * 10_000_000] for k in range(300, 900)])[0, 1] > 0.98


def test_deviations_are_given_and_everything_is_valid(undisturbed) -> None:
    last = walks.joint_states(undisturbed)[-1]
    assert all(last.valid)
    assert all(0.0 < std < 0.2 for i, std in enumerate(last.position_std[0]) if i != 0)


def test_live_view_tells_what_to_do_and_shows_the_bones(undisturbed) -> None:
    poses = walks.pictures(undisturbed)
    assert [pose.phase for pose in poses[:1]] == ["waiting"]
    assert poses[0].message == "Stand still, upright"
    assert any(pose.phase == "calibrating" and pose.message == "Walk a few steps" for pose in poses)
    last = poses[-1]
    assert last.phase == "estimating"
    assert last.message == ""
    assert {segment.segment for segment in last.segments} == set(walks.SEGMENTS)
    assert {status.state for status in last.sensors} == {SensorState.OK}
    times = [pose.captured_ns for pose in poses]
    assert np.median(np.diff(times)) == 40_000_000


SPLITS = (60, 200, 320, 700)


@cache
def frozen(estimator: str):
    """A node that was frozen at each split, what it said, and what was kept of it."""
    description = walks.describe(estimator=estimator)
    node = LowerBodyNode(description)
    outputs, kept = walks.run_and_freeze(node, walks.messages(description, walks.walk()[1]), SPLITS)
    return node, walks.text(outputs), kept


@pytest.mark.parametrize("estimator", list(LOWER_BODY_ESTIMATORS))
@pytest.mark.parametrize("split", SPLITS)
def test_split_and_resume_is_identical(estimator: str, split: int) -> None:
    node, whole, kept = frozen(estimator)
    description = walks.describe(estimator=estimator)
    resumed = LowerBodyNode(description)
    resumed.restore(json.loads(kept[split].state))
    outputs = walks.run(resumed, walks.messages(description, walks.walk()[1])[split:])
    assert walks.text(outputs) == whole[kept[split].outputs :]
    assert resumed.rejections() == node.rejections()


def test_to_be_frozen_changes_nothing(undisturbed) -> None:
    assert frozen("ekf")[1] == walks.text(undisturbed)


def test_two_sessions_interleaved_equal_each_alone(undisturbed) -> None:
    description = walks.describe()
    streams = [walks.messages(description, walks.walk(seed=seed)[1]) for seed in (0, 1)]
    alone = [undisturbed, walks.run(LowerBodyNode(description), streams[1])]
    nodes = [LowerBodyNode(description) for _ in streams]
    mixed: list[list] = [[], []]
    for pair in zip(*streams, strict=True):
        for i, message in enumerate(pair):
            mixed[i] += nodes[i].step(message)
    for i, node in enumerate(nodes):
        assert walks.text(mixed[i] + node.finish()) == walks.text(alone[i])
    assert walks.text(alone[0]) != walks.text(alone[1])


@pytest.mark.parametrize("ticks", [2, 5])
def test_batches_give_the_same_angles(undisturbed, ticks: int) -> None:
    description = walks.describe()
    outputs = walks.run(LowerBodyNode(description), walks.messages(description, walks.walk()[1], ticks=ticks))
    states = walks.joint_states(outputs)
    assert len(states[-2].captured_ns) == ticks
    one, many = walks.angles(undisturbed, "knee_flexion_left"), walks.angles(outputs, "knee_flexion_left")
    assert one == many


HUBS = (walks.SEGMENTS[:3], walks.SEGMENTS[3:])


def test_two_hubs_are_fused_in_captured_order_however_they_interleave(undisturbed) -> None:
    description = walks.describe(hubs=HUBS)
    stream = walks.messages(description, walks.walk()[1])
    second_first = sorted(stream, key=lambda m: (m.envelope.captured_ns, -int(m.stream.source[-1])))
    # One hub runs up to three messages ahead: less than the lateness.
    ahead = sorted(stream, key=lambda m: m.envelope.captured_ns - 35_000_000 * int(m.stream.source[-1]))
    results = [walks.run(LowerBodyNode(description), order) for order in (stream, second_first, ahead)]
    angles = [walks.angles(result, "knee_flexion_left") for result in results]
    assert angles[0] == angles[1] == angles[2]
    one = walks.angles(undisturbed, "knee_flexion_left")
    assert max(abs(one[t] - value) for t, value in angles[0].items() if t in one) < 1e-9


def test_a_hub_that_stays_away_is_not_waited_for() -> None:
    description = walks.describe(hubs=HUBS)
    stream = walks.messages(description, walks.walk()[1])
    kept = [m for m in stream if m.stream.source == "hub0" or m.envelope.captured_ns < 7_000_000_000]
    node = LowerBodyNode(description)
    outputs = [output for message in kept for output in node.step(message)]
    newest = walks.joint_states(outputs)[-1]
    assert newest.captured_ns[-1] >= 8_900_000_000
    assert newest.valid[walks.NAMES.index("knee_flexion_right")]
    assert not newest.valid[walks.NAMES.index("knee_flexion_left")]
    late = next(m for m in stream if m.stream.source == "hub1" and m.envelope.captured_ns > 7_000_000_000)
    assert node.step(late) == []
    assert {r.reason for r in node.rejections()} == {Reason.LATE}


def test_operator_marks_the_standing() -> None:
    marked = [StandingInterval(from_ns=500_000_000, to_ns=2_000_000_000)]
    description = walks.describe(standing=marked)
    outputs = walks.run(LowerBodyNode(description), walks.messages(description, walks.walk()[1]))
    (calibration,) = walks.calibrations(outputs)
    assert "marked" in calibration.method
    assert walks.joint_states(outputs)[0].captured_ns[0] <= 2_000_000_000


def test_wrong_units_are_counted_and_said() -> None:
    """Forces in g instead of m/s2."""
    samples = walks.walk()[1].copy()
    samples[:, SHANK_LEFT, 3:] /= 9.81
    node = LowerBodyNode(walks.describe())
    outputs = walks.run(node, walks.messages(walks.describe(), samples))
    assert [(r.subject, r.reason) for r in node.rejections()] == [("shank_left", Reason.WRONG_UNITS)]
    said = [pose.message for pose in walks.pictures(outputs)]
    assert any(message.startswith("Wrong units") and "shank_left" in message for message in said)
    last = walks.joint_states(outputs)[-1]
    assert not last.valid[walks.NAMES.index("knee_flexion_left")]
    assert last.valid[walks.NAMES.index("knee_flexion_right")]
    states = {status.sensor: status.state for status in walks.pictures(outputs)[-1].sensors}
    assert states["shank_left"] is SensorState.REJECTED


def test_sitting_is_not_taken_for_standing() -> None:
    """Thighs level: their skin normals point up."""
    samples = walks.walk()[1].copy()
    for s in (walks.SEGMENTS.index(Segment.THIGH_LEFT), walks.SEGMENTS.index(Segment.THIGH_RIGHT)):
        samples[:, s, 3:] = [0.3, -0.2, 9.8] + samples[:, s, :3]
    outputs = walks.run(LowerBodyNode(walks.describe()), walks.messages(walks.describe(), samples[:250]))
    assert walks.pictures(outputs)[-1].message == "Sitting, not standing: please stand up straight"
    assert not walks.joint_states(outputs)


def test_a_hub_with_another_number_of_sensors_is_refused() -> None:
    description = walks.describe()
    first = walks.messages(description, walks.walk()[1])[0]
    assert isinstance(first.payload, ImuBatch)
    node = LowerBodyNode(description)
    assert node.step(Message(first.stream, first.envelope, ImuBatch(sensors=first.payload.sensors[:3], marks=[]))) == []
    assert [(r.subject, r.reason, r.count) for r in node.rejections()] == [("hub0", Reason.WRONG_SHAPE, 1)]


def test_unknown_estimator_says_which_there_are() -> None:
    with pytest.raises(ValueError, match="rhythmic_ekf"):
        LowerBodyNode(walks.describe(estimator="magic"))


def test_empty_messages_lead_to_nothing() -> None:
    description = walks.describe()
    stream = walks.messages(description, walks.walk()[1])
    empty = ImuBatch(sensors=[walks.sensor_samples([], np.zeros((0, 6)))] * 5, marks=[])
    node = LowerBodyNode(description)
    outputs = []
    for message in stream:
        silent = 7.0e9 < message.envelope.captured_ns < 7.5e9
        outputs += node.step(Message(message.stream, message.envelope, empty) if silent else message)
    times = [t for state in walks.joint_states(outputs) for t in state.captured_ns]
    assert not [t for t in times if 7.0e9 < t < 7.5e9]
    assert max(abs(v) for state in walks.joint_states(outputs) for v in state.position[0]) < 3.0


def test_pauses_do_not_lose_the_movement_before_them() -> None:
    """A first half stride, two seconds of standing, then the walk: estimates begin with the first movement."""
    samples = walks.walk()[1]
    bow = np.concatenate([samples[250:310], samples[310:250:-1]]).copy()
    bow[60:, :, :3] *= -1.0
    stream = np.concatenate([samples[:250], bow, samples[:200], samples[200:]])
    description = walks.describe()
    outputs = walks.run(LowerBodyNode(description), walks.messages(description, stream))
    assert walks.joint_states(outputs)[0].captured_ns[0] <= 2_500_000_000
    assert walks.joint_states(outputs)[-1].captured_ns[0] == 10_000_000 * (len(stream) - 1)


def test_a_sensor_that_is_strapped_on_anew_begins_again() -> None:
    """Standing, a hand turns the left shank's sensor, standing again, walking: the second standing counts."""
    samples = walks.walk()[1].copy()
    tilt = np.array([[1.0, 0.0, 0.0], [0.0, np.cos(0.6), -np.sin(0.6)], [0.0, np.sin(0.6), np.cos(0.6)]])
    before = samples[:250].copy()
    for columns in (slice(0, 3), slice(3, 6)):
        before[:, SHANK_LEFT, columns] = before[:, SHANK_LEFT, columns] @ tilt
    turning = before[:40].copy()
    turning[:, SHANK_LEFT, 0] += 1.5
    description = walks.describe()
    stream = np.concatenate([before, turning, samples])
    outputs = walks.run(LowerBodyNode(description), walks.messages(description, stream))
    (calibration,) = walks.calibrations(outputs)
    shank = next(sensor for sensor in calibration.sensors if sensor.segment is Segment.SHANK_LEFT)
    R = matrix_from_quaternion(np.array(shank.quat_segment_from_sensor))
    assert angle_between(R[1], walks.mounting()[Segment.SHANK_LEFT][1]) < math.radians(2)
