"""Segmentation and metrics on walks that are slow, lame, turning, stopping, noisy or full of holes."""

from dataclasses import replace

import numpy as np
import pytest

from schemas.gait import GaitEvent, Stride
from schemas.metrics import SessionMetrics
from schemas.signals import STRIDE
from schemas.vocabulary import LOWER_BODY, GaitEventKind, Side
from services.bench.gait.joint_walks import JOINTS, RHYTHMS, JointTrack, joint_walk
from services.flow.message import Envelope, Message, Stream
from services.metrics.node import build as build_metrics
from services.segmentation.gait.strides import GAP, PHASE_LONG, PHASE_SHORT, SENSOR_MISSING
from services.segmentation.node import build as build_segmentation

WALK = "speed=1.1&seed=3&duration=30&turn_every=0"
DOFS = [dof.name for dof in LOWER_BODY]
STANDING_S = 4.0


def run(messages: list[Message], query: str = WALK) -> list:
    node = build_segmentation(joint_walk(query).description)
    return [output.payload for message in messages for output in node.step(message)] + [
        output.payload for output in node.finish()
    ]


def strides(payloads: list, side: Side | None = None) -> list[Stride]:
    return [p for p in payloads if isinstance(p, Stride) and side in (None, p.side)]


def contacts_s(payloads: list, side: Side) -> np.ndarray:
    kind = GaitEventKind.INITIAL_CONTACT
    return np.array(
        [p.captured_ns * 1e-9 for p in payloads if isinstance(p, GaitEvent) and (p.side, p.kind) == (side, kind)]
    )


def noisy(track: JointTrack, angle: float, rate: float) -> JointTrack:
    rng = np.random.default_rng(1)
    shape = track.position.shape
    return replace(
        track,
        position=track.position + angle * rng.standard_normal(shape),
        velocity=track.velocity + rate * rng.standard_normal(shape),
    )


def without(messages: list[Message], from_s: float, to_s: float, streams=(JOINTS, RHYTHMS)) -> list[Message]:
    return [m for m in messages if m.stream not in streams or not from_s < m.envelope.captured_ns * 1e-9 <= to_s]


@pytest.mark.parametrize(
    "query",
    [
        "speed=0.3&duration=30",
        "speed=0.6&duration=30",
        "speed=1.6&duration=30",
        "speed=0.8&asymmetry=0.5&duration=30",
        "speed=0.4&asymmetry=0.4&duration=30",
        "speed=1.0&turn_every=8&duration=40",
        "speed=1.0&rate=40&duration=30",
    ],
)
@pytest.mark.parametrize("noise", [(0.0, 0.0), (0.005, 0.1)], ids=["clean", "noisy"])
def test_all_strides_of_many_walks(query, noise):
    walk = joint_walk(query)
    payloads = run(noisy(walk.track, *noise).messages(), query)
    for side in Side:
        true = walk.contacts_s(side)
        found = contacts_s(payloads, side)
        # The very first and last movements of a foot may be too small for a step.
        assert len(true) - 2 <= len(found) <= len(true)
        assert max(min(abs(found - at)) for at in true[1:-1]) < 0.12
        assert all(stride.valid for stride in strides(payloads, side))
        assert len(strides(payloads, side)) == len(found) - 1


def test_strides_are_measured_as_they_were_walked():
    walk = joint_walk(WALK)
    for stride in strides(run(walk.track.messages()))[4:-4]:
        path = walk.body.ankle(stride.side).position
        start, end = (
            np.array([np.interp(ns * 1e-9, walk.track.time_s, path[:, axis]) for axis in (0, 2)])
            for ns in (stride.start_ns, stride.end_ns)
        )
        assert stride.stride_length_m == pytest.approx(np.linalg.norm(end - start), rel=0.05)
        assert stride.walking_speed == pytest.approx(1.1, rel=0.07)
        assert stride.phase_advance is None or stride.phase_advance == pytest.approx(2 * np.pi, rel=0.1)
        assert 0.55 < stride.stance_fraction < 0.70


def test_turning_strides_are_flagged_and_only_they():
    query = "speed=1.0&turn_every=12&turn_time=3&duration=40"
    payloads = run(joint_walk(query).track.messages(), query)
    track = joint_walk(query).track
    heading = track.position[:, DOFS.index("pelvis_rotation")]
    for stride in strides(payloads):
        at = np.interp([stride.start_ns * 1e-9, stride.end_ns * 1e-9], track.time_s, heading)
        assert stride.turning == (abs(at[1] - at[0]) > 0.26)
    assert 4 <= sum(stride.turning for stride in strides(payloads)) <= 20


def test_no_stride_spans_a_stop():
    query = "speed=1.0&stop_every=8&pause=4&duration=45"
    walk = joint_walk(query)
    payloads = run(walk.track.messages(), query)
    assert all(stride.stride_time_s < 2.0 for stride in strides(payloads))
    assert all(stride.valid for stride in strides(payloads))
    assert len(strides(payloads)) >= sum(len(walk.contacts_s(side)) for side in Side) - 5 * len(Side) * 2


@pytest.mark.parametrize("start_s", [10.0, 10.13, 10.4, 10.77])
def test_a_stride_over_a_gap_does_not_count(start_s):
    messages = joint_walk(WALK).track.messages()
    payloads = run(without(messages, start_s, start_s + 0.3))
    spanning = [s for s in strides(payloads) if s.start_ns < (start_s + 0.25) * 1e9 and s.end_ns > start_s * 1e9]
    assert spanning
    assert {stride.rejected_because for stride in spanning} == {GAP}
    assert all(stride.valid for stride in strides(payloads) if stride not in spanning)


def test_a_missing_message_is_no_gap():
    messages = joint_walk(WALK).track.messages()
    payloads = run(without(messages, 10.0, 10.06))
    assert all(stride.valid for stride in strides(payloads))
    assert len(strides(payloads)) == len(strides(run(messages)))


def test_a_gap_in_the_rhythm_alone_loses_no_stride():
    messages = joint_walk(WALK).track.messages()
    whole = run(messages)
    payloads = run(without(messages, 10.0, 12.0, (RHYTHMS,)))
    assert [(s.side, s.start_ns, s.end_ns, s.valid) for s in strides(payloads)] == [
        (s.side, s.start_ns, s.end_ns, s.valid) for s in strides(whole)
    ]
    assert sum(s.phase_advance is None for s in strides(payloads)) > sum(
        s.phase_advance is None for s in strides(whole)
    )


def unseen(names: tuple[str, ...], from_s: float, to_s: float) -> list[Message]:
    track = joint_walk(WALK).track
    hidden = track.messages(valid=tuple(name not in names for name in DOFS))
    return [
        b if from_s <= a.envelope.captured_ns * 1e-9 < to_s else a
        for a, b in zip(track.messages(), hidden, strict=True)
    ]


def test_a_leg_without_its_sensor_has_no_events_and_the_other_goes_on():
    payloads = run(unseen(("knee_flexion_left",), 10.0, 16.0))
    left, right = contacts_s(payloads, Side.LEFT), contacts_s(payloads, Side.RIGHT)
    assert not np.any((left > 10.0) & (left < 16.0))
    assert np.sum((right > 10.0) & (right < 16.0)) >= 4
    alone = [s for s in strides(payloads, Side.RIGHT) if s.start_ns > 10.2e9 and s.end_ns < 15.8e9]
    assert alone
    for stride in alone:
        assert stride.valid
        assert stride.step_length_m is stride.stride_length_m is stride.walking_speed is None
    assert {s.rejected_because for s in strides(payloads, Side.LEFT)} <= {None, SENSOR_MISSING}
    assert [s.valid for s in strides(payloads, Side.LEFT)][-2:] == [True, True]


def test_a_short_loss_spoils_the_stride_it_falls_into():
    payloads = run(unseen(("knee_flexion_left",), 10.0, 10.1))
    within = [s for s in strides(payloads, Side.LEFT) if s.start_ns < 10.0e9 < s.end_ns]
    assert [stride.rejected_because for stride in within] == [SENSOR_MISSING]


def test_without_the_pelvis_nothing_is_claimed():
    assert run(unseen(("pelvis_tilt",), 0.0, 60.0)) == []


def test_a_sensor_that_comes_late():
    payloads = run(unseen(("hip_flexion_right",), 0.0, 12.0))
    assert min(contacts_s(payloads, Side.RIGHT)) > 12.0
    assert strides(payloads, Side.RIGHT)
    assert all(s.valid for s in strides(payloads, Side.RIGHT))


@pytest.mark.parametrize(("factor", "reason"), [(2.0, PHASE_LONG), (0.5, PHASE_SHORT)])
def test_a_rhythm_on_the_wrong_period_is_an_objection(factor, reason):
    track = joint_walk(WALK).track
    payloads = run(replace(track, phase=factor * track.phase).messages())
    locked = [s for s in strides(payloads) if s.phase_advance is not None]
    assert len(locked) > 20
    assert {s.rejected_because for s in locked} == {reason}


def test_an_unlocked_rhythm_changes_no_stride():
    track = joint_walk(WALK).track
    payloads = run(replace(track, phase=np.full_like(track.phase, np.nan)).messages())
    assert [(s.side, s.start_ns) for s in strides(payloads)] == [
        (s.side, s.start_ns) for s in strides(run(track.messages()))
    ]
    assert all(s.valid for s in strides(payloads))


def test_squatting_is_not_walking():
    time_s = np.arange(3000) / 100
    depth = 0.5 * (1 - np.cos(2 * np.pi * time_s / 2.5))
    track = joint_walk(WALK).track
    position, velocity = np.zeros((2, 3000, len(DOFS)))
    for name, angle in (("hip_flexion", 1.2), ("knee_flexion", 1.8)):
        for side in Side:
            position[:, DOFS.index(f"{name}_{side}")] = angle * depth
            velocity[:, DOFS.index(f"{name}_{side}")] = np.gradient(angle * depth, 0.01)
    payloads = run(replace(track, time_s=time_s, position=position, velocity=velocity, phase=0 * time_s).messages())
    assert not any(stride.valid for stride in strides(payloads))


def test_a_leap_of_the_heading_is_survived():
    track = joint_walk(WALK).track
    position = track.position.copy()
    position[1500:, DOFS.index("pelvis_rotation")] += 3.0
    payloads = run(replace(track, position=position).messages())
    assert sum(stride.turning for stride in strides(payloads)) <= 3
    assert len(strides(payloads)) == len(strides(run(track.messages())))


def test_a_lame_leg_shows_in_the_metrics():
    query = "speed=0.9&asymmetry=0.4&duration=60&seed=2"
    found = strides(run(joint_walk(query).track.messages(), query))
    node = build_metrics(joint_walk(query).description)
    for number, stride in enumerate(found):
        node.step(Message(Stream(STRIDE, "segmentation"), Envelope(0, number, stride.end_ns), stride))
    final = node.finish()[0].payload
    assert isinstance(final, SessionMetrics)
    table = {(metric.name, metric.side): metric for metric in final.metrics}
    assert table["knee_flexion_range", "left"].value < 0.75 * table["knee_flexion_range", "right"].value
    assert table["knee_flexion_range_ratio_larger_to_smaller", None].value > 1.3
    assert table["walking_speed", None].value == pytest.approx(0.9, rel=0.1)
    assert table["stride_time_cv", None].value < 0.06
    assert table["strides_rejected", "left"].value == 0
    assert len(final.curves) == len(DOFS)
