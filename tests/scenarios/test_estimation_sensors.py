"""Estimation under sensor faults: what is still known stays right, what is not known says so, and all comes back."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from schemas.health import Reason
from schemas.imu import ImuBatch, SensorSamples
from schemas.kinematics import JointState, LivePose
from schemas.vocabulary import LOWER_BODY, SensorState
from services.estimation.lower_body.node import LowerBodyNode
from services.faults.faults import ClockStep, HubGap, SensorOff, SensorStuck, Spike
from services.faults.inject import inject
from services.flow.message import Message, Output
from services.ingest.source import iter_messages, open_source

WALK = "synthetic:walk?speed=1.1&seed=3&duration=17"
NAMES = [dof.name for dof in LOWER_BODY]
OBSERVED_BY = {
    "pelvis": ("pelvis", "hip"),
    "thigh_left": ("hip_flexion_left", "knee_flexion_left"),
    "thigh_right": ("hip_flexion_right", "knee_flexion_right"),
    "shank_left": ("knee_flexion_left",),
    "shank_right": ("knee_flexion_right",),
}


@cache
def recorded():
    source = open_source(WALK, session="s", estimator="rhythmic_ekf")
    stream = [m for m in iter_messages(source) if m.stream.signal.name == "imu" and not m.envelope.final]
    return source.describe(), tuple(stream)


def sensors() -> list[str]:
    return [sensor.name for sensor in recorded()[0].hubs[0].sensors]


def run(messages) -> tuple[LowerBodyNode, list[Output]]:
    node = LowerBodyNode(recorded()[0])
    return node, [output for message in messages for output in node.step(message)]


def damaged(*faults) -> tuple[LowerBodyNode, list[Output]]:
    return run(inject(recorded()[1], sensors(), faults))


@cache
def clean() -> tuple[Output, ...]:
    return tuple(run(recorded()[1])[1])


def states(outputs) -> list[JointState]:
    return [output.payload for output in outputs if isinstance(output.payload, JointState)]


def series(outputs, name: str) -> dict[int, float]:
    i = NAMES.index(name)
    return {t: row[i] for s in states(outputs) for t, row in zip(s.captured_ns, s.position, strict=True)}


def validity(outputs, name: str, from_s: float, to_s: float) -> set[bool]:
    i = NAMES.index(name)
    return {s.valid[i] for s in states(outputs) if from_s * 1e9 <= s.captured_ns[-1] < to_s * 1e9}


def worst_deg(outputs, name: str, from_s: float, to_s: float) -> float:
    reference, other = series(clean(), name), series(outputs, name)
    common = [t for t in other if t in reference and from_s * 1e9 <= t < to_s * 1e9]
    assert common
    return math.degrees(max(abs(reference[t] - other[t]) for t in common))


def sensor_states(outputs, name: str, from_s: float, to_s: float) -> set[SensorState]:
    poses = [o.payload for o in outputs if isinstance(o.payload, LivePose)]
    inside = [pose for pose in poses if from_s * 1e9 <= pose.captured_ns < to_s * 1e9]
    return {status.state for pose in inside for status in pose.sensors if status.sensor == name}


def affected(sensor: str) -> list[str]:
    return [name for name in NAMES if name.startswith(OBSERVED_BY[sensor])]


def assert_finite(outputs) -> None:
    for state in states(outputs):
        table = [*state.position, *state.velocity, *state.acceleration, *state.position_std, *state.velocity_std]
        assert np.isfinite(table).all()


@pytest.mark.parametrize("sensor", list(OBSERVED_BY))
def test_off_at_the_start(sensor: str) -> None:
    """Its joints are never valid, the others are as good as ever."""
    _, outputs = damaged(SensorOff(sensor, 0.0, 60.0))
    assert_finite(outputs)
    for name in ("knee_flexion_left", "knee_flexion_right", "hip_flexion_left", "hip_flexion_right"):
        if name in affected(sensor):
            assert validity(outputs, name, 8.0, 17.0) == {False}
        else:
            assert validity(outputs, name, 8.0, 17.0) == {True}
            assert worst_deg(outputs, name, 10.0, 17.0) < 6.0
    assert sensor_states(outputs, sensor, 8.0, 17.0) == {SensorState.MISSING}


def test_on_midway() -> None:
    """A sensor that was never seen standing cannot be used: its joints stay invalid and the screen says why."""
    _, outputs = damaged(SensorOff("shank_left", 0.0, 12.0))
    assert_finite(outputs)
    assert validity(outputs, "knee_flexion_left", 12.5, 17.0) == {False}
    assert validity(outputs, "knee_flexion_right", 12.5, 17.0) == {True}
    assert sensor_states(outputs, "shank_left", 12.5, 17.0) == {SensorState.CALIBRATING}
    last = [output.payload for output in outputs if isinstance(output.payload, LivePose)][-1]
    assert last.message.startswith("Sensor shank_left came after the calibration")


@pytest.mark.parametrize("sensor", list(OBSERVED_BY))
def test_off_midway_and_back(sensor: str) -> None:
    """Within a second it is missing and its joints are not valid; three seconds after its return all is as before."""
    _, outputs = damaged(SensorOff(sensor, 10.0, 12.0))
    assert_finite(outputs)
    assert sensor_states(outputs, sensor, 11.0, 12.0) == {SensorState.MISSING}
    for name in affected(sensor):
        assert validity(outputs, name, 11.0, 12.0) == {False}
        assert validity(outputs, name, 13.1, 17.0) == {True}
    for name in ("knee_flexion_left", "knee_flexion_right"):
        if name not in affected(sensor):
            assert worst_deg(outputs, name, 10.0, 12.0) < 3.0
        assert worst_deg(outputs, name, 15.0, 17.0) < 3.0


def test_two_sensors_off_leave_the_other_leg() -> None:
    _, outputs = damaged(SensorOff("thigh_left", 10.0, 20.0), SensorOff("shank_left", 10.0, 20.0))
    assert_finite(outputs)
    assert validity(outputs, "knee_flexion_right", 11.0, 17.0) == {True}
    assert worst_deg(outputs, "knee_flexion_right", 10.0, 17.0) < 3.0


def test_stuck() -> None:
    node, outputs = damaged(SensorStuck("thigh_right", 10.0, 12.0))
    assert_finite(outputs)
    assert sensor_states(outputs, "thigh_right", 11.0, 12.0) == {SensorState.STUCK}
    assert validity(outputs, "knee_flexion_right", 11.0, 12.0) == {False}
    assert [(r.subject, r.reason) for r in node.rejections()] == [("thigh_right", Reason.STUCK)]
    assert worst_deg(outputs, "knee_flexion_right", 15.0, 17.0) < 3.0


def test_spike_is_refused_and_leaves_no_trace() -> None:
    node, outputs = damaged(Spike("shank_right", 10.0, 30.0, 150.0), Spike("pelvis", 11.0, -30.0, -150.0))
    assert {(r.subject, r.reason, r.count) for r in node.rejections()} == {
        ("shank_right", Reason.OUT_OF_RANGE, 1),
        ("pelvis", Reason.OUT_OF_RANGE, 1),
    }
    assert worst_deg(outputs, "knee_flexion_right", 10.0, 17.0) < 2.0


@pytest.mark.parametrize("length_s", [0.1, 0.8, 3.0])
def test_gap_of_everything(length_s: float) -> None:
    _, outputs = damaged(HubGap(10.0, 10.0 + length_s))
    assert_finite(outputs)
    assert validity(outputs, "knee_flexion_left", 11.1 + length_s, 17.0) == {True}
    assert worst_deg(outputs, "knee_flexion_left", 13.0 + length_s, 17.0) < 3.0


def test_clock_that_jumps_back() -> None:
    """The samples are refused until the clock has caught up with itself; then all goes on."""
    node, outputs = damaged(ClockStep("shank_left", 10.0, -0.5))
    assert_finite(outputs)
    assert {(r.subject, r.reason) for r in node.rejections()} <= {
        ("shank_left", Reason.CLOCK_BACKWARDS),
        ("shank_left", Reason.LATE),
    }
    assert worst_deg(outputs, "knee_flexion_right", 10.0, 17.0) < 3.0


def change(message: Message, sensor: str, **fields) -> Message:
    """The message with some fields of one sensor's samples replaced, without validation."""
    assert isinstance(message.payload, ImuBatch)
    samples = list(message.payload.sensors)
    i = sensors().index(sensor)
    values = samples[i].model_dump() | fields
    samples[i] = SensorSamples.model_construct(**values)
    return replace(message, payload=ImuBatch.model_construct(sensors=samples, marks=message.payload.marks))


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_numbers_that_are_none_go_no_further(bad: float) -> None:
    stream = [
        change(m, "shank_left", angular_velocity=[[bad, 0.0, 0.0]]) if 10e9 < m.envelope.captured_ns < 10.1e9 else m
        for m in recorded()[1]
    ]
    node, outputs = run(stream)
    assert_finite(outputs)
    assert [(r.subject, r.reason, r.count) for r in node.rejections()] == [("shank_left", Reason.NOT_FINITE, 9)]
    assert worst_deg(outputs, "knee_flexion_left", 12.0, 17.0) < 3.0


def test_repeated_time_stamps_count_once() -> None:
    first, last = 10_000_000_000, 10_100_000_000
    stream = [
        change(m, "shank_left", captured_ns=[first]) if first < m.envelope.captured_ns <= last else m
        for m in recorded()[1]
    ]
    node, outputs = run(stream)
    (refused,) = node.rejections()
    assert refused.subject == "shank_left"
    assert refused.reason is Reason.CLOCK_BACKWARDS or refused.reason is Reason.LATE
    times = [t for state in states(outputs) for t in state.captured_ns]
    assert times == sorted(set(times))
    assert worst_deg(outputs, "knee_flexion_left", 13.0, 17.0) < 3.0
