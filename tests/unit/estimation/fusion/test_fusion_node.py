"""Sensors and a camera on one walker: one body, whatever is away, however messages come."""

import json
from functools import cache

import numpy as np
import pytest

from schemas.kinematics import Calibration, JointCentres, JointState, LivePose
from schemas.rhythm import Rhythm
from schemas.signals import IMU, JOINT_STATE, SKELETON
from schemas.vocabulary import BODY_MODELS
from services.bench.kinect.fusion_section import errors, follow, truth_of
from services.estimation.fusion.node import FusionNode
from services.estimation.node import build
from services.estimation.refusal import RefusingNode
from services.flow.message import Message
from services.ingest.source import iter_messages, open_source

WALK = "synthetic:walk?camera=1&duration=32&seed=7&speed=1.0"
AWAY_S, BACK_S = 24.0, 29.0


@cache
def played(options: str = "", ticks: int = 1):
    source = open_source(WALK + options, estimator="fusion")
    messages = [m for m in iter_messages(source, ticks) if m.payload is not None]
    return source.describe(), [m for m in messages if m.stream.signal in (IMU, SKELETON)], messages


def outputs_of(node, messages: list[Message]) -> list:
    return [out for message in messages for out in node.step(message)]


def told(outputs) -> list[tuple]:
    """What was said, in order."""
    return [(out.signal.name, out.captured_ns, out.payload.model_dump_json()) for out in outputs]


@cache
def whole_walk() -> tuple:
    description, messages, _ = played()
    node = FusionNode(description)
    return tuple(outputs_of(node, messages) + node.finish())


def payloads(outputs, model):
    return [out.payload for out in outputs if isinstance(out.payload, model)]


def test_rows_are_of_the_whole_body_in_order_each_time_once_and_finite():
    states = payloads(whole_walk(), JointState)
    times = np.concatenate([state.captured_ns for state in states])
    assert (np.diff(times) > 0).all()
    assert {state.model for state in states} == {"whole_body"}
    assert np.isfinite(np.concatenate([state.position for state in states])).all()
    # The camera leads from the first second on, the sensors at 100 Hz once they are calibrated.
    assert times[0] < 2e9
    assert np.median(np.diff(times[times > 20e9])) == 10_000_000


def test_rhythm_and_joint_centres_come_with_every_joint_state():
    outputs = whole_walk()
    states, rhythms, centres = (payloads(outputs, model) for model in (JointState, Rhythm, JointCentres))
    assert [s.captured_ns for s in states] == [r.captured_ns for r in rhythms] == [c.captured_ns for c in centres]


def test_arms_are_the_cameras_and_legs_the_sensors():
    states = payloads(whole_walk(), JointState)
    names = [dof.name for dof in BODY_MODELS["whole_body"]]
    late = [state for state in states if state.captured_ns[0] > 20e9]
    seen = np.mean([state.valid for state in late], axis=0)
    assert seen[names.index("elbow_flexion_left")] > 0.5
    assert seen[names.index("trunk_flexion")] > 0.8
    assert seen[names.index("knee_flexion_left")] == 1.0


def test_calibration_tells_of_both():
    last = payloads(whole_walk(), Calibration)[-1]
    assert (last.model, last.estimator) == ("whole_body", "fusion")
    assert len(last.lengths) == 12
    assert len(last.sensors) == 5
    assert "camera" in last.method
    assert "sensors" in last.method


def test_the_picture_has_sensors_camera_and_the_whole_body():
    pose = payloads(whole_walk(), LivePose)[-1]
    assert len(pose.centres) == 15
    assert len(pose.sensors) == 5
    assert len(pose.cameras) == 1
    assert pose.phase == "estimating"


@pytest.mark.parametrize(("source", "most_deg"), [("camera", 2.0), ("imu", 4.0)])
def test_a_source_that_is_away_is_stood_in_for(source, most_deg):
    """Here after a few strides of comparison only; `ambula bench kinect fusion` measures it after half a minute."""
    description, messages, everything = played(f"&{source}_away_at={AWAY_S}&{source}_away_for={BACK_S - AWAY_S}")
    track, truth = follow(description, messages, "fusion"), truth_of(description, everything)
    before, within = errors(track, truth, AWAY_S - 5.0, AWAY_S), errors(track, truth, AWAY_S, BACK_S)
    assert len(within) >= 100
    assert np.isfinite(within).mean() > 0.95
    assert np.sqrt(np.nanmean(within**2)) < np.sqrt(np.nanmean(before**2)) + most_deg
    assert np.isfinite(errors(track, truth, BACK_S + 1.0, BACK_S + 2.0)).all()


def test_the_batching_of_messages_decides_nothing():
    description, single, _ = played()
    _, batched, _ = played("", 5)
    rows = {}
    for name, messages in (("single", single), ("batched", batched)):
        node = FusionNode(description)
        states = payloads([*outputs_of(node, messages[: len(messages) * 3 // 4])], JointState)
        rows[name] = {t: p for s in states for t, p in zip(s.captured_ns, s.position, strict=True)}
    common = sorted(rows["single"].keys() & rows["batched"].keys())
    assert len(common) > 800
    legs = [i for i, dof in enumerate(BODY_MODELS["whole_body"]) if dof.name.startswith(("hip", "knee"))]
    apart = [np.abs(np.subtract(rows["single"][t], rows["batched"][t]))[legs].max() for t in common if t > 20e9]
    assert np.max(apart) < np.radians(0.5)


def test_it_goes_on_from_a_snapshot_to_the_last_bit():
    description, messages, _ = played()
    for share in (0.2, 0.7):
        cut = int(share * len(messages))
        first = FusionNode(description)
        before = outputs_of(first, messages[:cut])
        second = FusionNode(description)
        second.restore(json.loads(json.dumps(first.snapshot())))
        after = outputs_of(second, messages[cut:]) + second.finish()
        assert told([*before, *after]) == told(whole_walk())


def test_without_both_sources_it_says_so():
    description, _, _ = played()
    for lacking in ({"hubs": []}, {"cameras": []}):
        node = build(description.model_copy(update=lacking))
        assert isinstance(node, RefusingNode)
        assert "fusion needs" in node.reason.lower()


def test_a_camera_that_sees_nobody_leaves_the_sensors_alone():
    description, messages, _ = played()
    sensors = [message for message in messages if message.stream.signal is IMU]
    alone, fused = (
        build(description.model_copy(update={"estimator": "rhythmic_ekf", "cameras": []})),
        build(description),
    )
    expected = payloads(outputs_of(alone, sensors) + alone.finish(), JointState)
    found = [out.payload for out in outputs_of(fused, sensors) + fused.finish() if out.signal is JOINT_STATE]
    names = [dof.name for dof in BODY_MODELS["whole_body"]]
    knee = [dof.name for dof in BODY_MODELS["lower_body"]].index("knee_flexion_left")
    assert [state.captured_ns for state in found] == [state.captured_ns for state in expected]
    for one, other in zip(expected, found, strict=True):
        np.testing.assert_array_equal(
            np.array(one.position)[:, knee], np.array(other.position)[:, names.index("knee_flexion_left")]
        )
