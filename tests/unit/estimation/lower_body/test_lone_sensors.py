"""Sessions of which only feet or only the lower back wear a sensor, or too many do."""

import json
from functools import cache

import numpy as np
import pytest

from schemas.kinematics import Calibration, JointState, LivePose, SegmentMotion
from schemas.session import SessionDescription
from schemas.vocabulary import EventSource, Segment, SensorState, Side
from services.bench.gait.worn import wearing, worn_only
from services.estimation.lower_body.node import LowerBodyNode
from services.flow.message import Message
from services.ingest.source import iter_messages, open_source

WALK = "synthetic:walk?speed=1.1&seed=3&duration=12&pause=1&feet=1&mounting=0.5"
FEET = frozenset({Segment.FOOT_LEFT, Segment.FOOT_RIGHT})
BACK = frozenset({Segment.PELVIS})
SHANKS = frozenset({Segment.SHANK_LEFT, Segment.SHANK_RIGHT})


@cache
def session(
    worn: frozenset[Segment], ticks: int = 1, walk: str = WALK
) -> tuple[SessionDescription, tuple[Message, ...]]:
    source = open_source(walk, session="s", estimator="ekf")
    description = source.describe()
    messages = [m for m in worn_only(iter_messages(source, ticks), description, worn) if m.stream.signal.name == "imu"]
    return wearing(description, worn), tuple(m for m in messages if m.payload is not None)


def taken(worn: frozenset[Segment], ticks: int = 1) -> list:
    description, messages = session(worn, ticks)
    node = LowerBodyNode(description)
    return [output for message in messages for output in node.step(message)] + node.finish()


@cache
def run(worn: frozenset[Segment]) -> tuple:
    return tuple(taken(worn))


def payloads(outputs, kind) -> list:
    return [output.payload for output in outputs if isinstance(output.payload, kind)]


def column(outputs, segment: Segment, name: str) -> np.ndarray:
    found = [s for motion in payloads(outputs, SegmentMotion) for s in motion.segments if s.segment is segment]
    return np.array([row for samples in found for row in getattr(samples, name)])


@pytest.mark.parametrize("worn", [FEET, BACK, FEET | BACK], ids=["feet", "back", "both"])
def test_motion_comes_beside_every_joint_state(worn):
    outputs = run(worn)
    states, motions = payloads(outputs, JointState), payloads(outputs, SegmentMotion)
    assert len(states) > 700
    assert [state.captured_ns for state in states] == [motion.captured_ns for motion in motions]
    assert all(np.isfinite(state.position).all() and np.isfinite(state.position_std).all() for state in states[::50])


def test_a_shank_needs_no_motion_of_its_own():
    assert payloads(run(SHANKS), SegmentMotion) == []


def test_feet_alone_have_no_valid_joint():
    assert not any(any(state.valid) for state in payloads(run(FEET), JointState))
    assert all(state.observed == [] for state in payloads(run(FEET), JointState))


@pytest.mark.parametrize("side", list(Side))
def test_a_foot_turns_forward_in_swing(side):
    rate = column(run(FEET), Segment(f"foot_{side}"), "angular_velocity")
    # Back briefly and fast at push-off, forward longer: whichever way the sensor was strapped on.
    assert np.abs(rate[150:, 2]).mean() > 3 * np.abs(rate[150:, :2]).mean(axis=0).max()
    angle = np.cumsum(rate[:, 2]) * 0.01
    angle -= np.median(angle)
    assert np.quantile(angle, 0.02) < -1.5 * np.quantile(angle, 0.98)


def test_the_back_is_weightless_in_standing_and_bobs_twice_a_stride():
    acceleration = column(run(BACK), Segment.PELVIS, "acceleration")
    assert np.abs(acceleration[:150].mean(axis=0)).max() < 0.1
    walking = acceleration[500:, 1]
    assert walking.mean() == pytest.approx(0.0, abs=0.15)
    assert walking.std() > 0.5


def test_batches_do_not_matter():
    worn, batched = FEET | BACK, taken(FEET | BACK, ticks=7)
    for name in ("acceleration", "angular_velocity"):
        for segment in worn:
            expected = column(run(worn), segment, name)
            np.testing.assert_array_equal(column(batched, segment, name), expected)


@pytest.mark.parametrize("cut", [300, 750])
def test_a_resumed_node_goes_on_alike(cut):
    description, messages = session(FEET | BACK)
    node = LowerBodyNode(description)
    outputs = [output for message in messages[:cut] for output in node.step(message)]
    resumed = LowerBodyNode(description)
    resumed.restore(json.loads(json.dumps(node.snapshot())))
    outputs += [output for message in messages[cut:] for output in resumed.step(message)] + resumed.finish()
    assert [output.payload for output in outputs] == [output.payload for output in run(FEET | BACK)]


def test_the_calibration_says_what_is_used_and_what_is_not():
    outputs = run((SHANKS | FEET | BACK) - {Segment.SHANK_RIGHT})
    [calibration] = payloads(outputs, Calibration)
    assert calibration.events_from == {Side.LEFT: EventSource.SHANK, Side.RIGHT: EventSource.FOOT}
    assert list(calibration.unused) == ["foot_left"]
    assert {sensor.segment for sensor in calibration.sensors} == {"pelvis", "shank_left", "foot_right"}
    picture = payloads(outputs, LivePose)[-1]
    states = {status.sensor: status.state for status in picture.sensors}
    assert states.pop("foot_left") is SensorState.UNUSED
    assert set(states.values()) == {SensorState.OK}
    assert picture.message == ""


@pytest.mark.parametrize("worn", [FEET, BACK], ids=["feet", "back"])
def test_walking_alone_will_do(worn):
    """The standing at both ends is cut off."""
    description, messages = session(worn, walk=WALK.replace("duration=12", "duration=18"))
    node = LowerBodyNode(description)
    outputs = [output for message in messages[430:1300] for output in node.step(message)] + node.finish()
    [calibration] = payloads(outputs, Calibration)
    assert calibration.method == "walking alone"
    assert calibration.quality <= 0.4
    [expected] = payloads(run(worn), Calibration)
    for ours, theirs in zip(calibration.sensors, expected.sensors, strict=True):
        # The mean posture of walking is not that of standing, and the simulated foot rolls all through stance.
        apart = 2 * np.arccos(min(1.0, abs(np.dot(ours.quat_segment_from_sensor, theirs.quat_segment_from_sensor))))
        assert apart < 0.35
