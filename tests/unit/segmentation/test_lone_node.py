"""The node where feet or the lower back tell the events: its three streams, its state, its silences."""

import json
import random
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from schemas.gait import GaitEvent, Stride
from schemas.health import Reason
from schemas.kinematics import SegmentMotion, SegmentSamples
from schemas.vocabulary import GaitEventKind, Segment, Side
from services.bench.gait.joint_walks import joint_walk
from services.bench.gait.worn import wearing
from services.flow.message import Message
from services.segmentation.gait.strides import SENSOR_MISSING
from services.segmentation.intake import JOINTS_FROM, MOTION_FROM, RHYTHM_FROM
from services.segmentation.node import build
from services.segmentation.parameters import SegmentationParameters

WALK = "speed=1.1&seed=3&duration=16"
BACK, FEET = frozenset({Segment.PELVIS}), frozenset({Segment.FOOT_LEFT, Segment.FOOT_RIGHT})
IC, TO = GaitEventKind.INITIAL_CONTACT, GaitEventKind.TOE_OFF
STRIDE_S = 1.1
PARAMETERS = SegmentationParameters()


def back(time_s: float) -> tuple[list[float], list[float]]:
    """Acceleration and turning of a back that stands for 2 s and then walks."""
    walked = max(0.0, time_s - 2.0)
    up = -2.0 * np.cos(4 * np.pi * walked / STRIDE_S) if walked else 0.0
    right = np.sin(2 * np.pi * walked / STRIDE_S)
    return [0.0, float(up), float(right)], [0.0, 0.3 if walked else 0.0, 0.0]


def foot(time_s: float, shift_s: float) -> tuple[list[float], list[float]]:
    """A foot that turns forward in the second half of each stride."""
    walked = max(0.0, time_s - 2.0 - shift_s)
    return [0.0, 0.0, 0.0], [0.0, 0.0, float(-3.0 * np.sin(2 * np.pi * walked / STRIDE_S))]


def samples(segment: Segment, captured_ns: list[int]) -> SegmentSamples:
    shift_s = STRIDE_S / 2 if segment is Segment.FOOT_LEFT else 0.0
    rows = [back(ns * 1e-9) if segment is Segment.PELVIS else foot(ns * 1e-9, shift_s) for ns in captured_ns]
    return SegmentSamples(
        segment=segment,
        captured_ns=captured_ns,
        acceleration=[row[0] for row in rows],
        angular_velocity=[row[1] for row in rows],
    )


@cache
def stream(worn: frozenset[Segment], batch: int = 5) -> tuple[Message, ...]:
    """joint_state, rhythm and segment_motion in turn. No joint is valid, no rhythm locked."""
    messages: list[Message] = []
    track = joint_walk(WALK).track
    track = replace(track, phase=np.full_like(track.phase, np.nan))
    for message in track.messages(batch, valid=(False,) * 15):
        messages.append(message)
        if message.stream == RHYTHM_FROM:
            times = message.payload.captured_ns
            motion = SegmentMotion(captured_ns=times, segments=[samples(s, times) for s in sorted(worn)])
            messages.append(Message(MOTION_FROM, message.envelope, motion))
    return tuple(messages)


def node_of(worn: frozenset[Segment]):
    description = joint_walk(WALK + "&feet=1").description
    return build(wearing(description, worn))


def run(worn, messages=None, node=None) -> list:
    node = node or node_of(worn)
    return [o for message in messages or stream(worn) for o in node.step(message)] + node.finish()


def plain(outputs) -> list[tuple[str, int, str]]:
    return [(output.signal.name, output.captured_ns, output.payload.model_dump_json()) for output in outputs]


def payloads(outputs, kind) -> list:
    return [output.payload for output in outputs if isinstance(output.payload, kind)]


def without(messages, from_s: float, to_s: float):
    """The motion's samples between two times are lost, the joint states go on."""
    kept = []
    for message in messages:
        payload = message.payload
        if isinstance(payload, SegmentMotion) and from_s <= payload.captured_ns[0] * 1e-9 < to_s:
            empty = [SegmentSamples(segment=s.segment, captured_ns=[], acceleration=[], angular_velocity=[])
                     for s in payload.segments]  # fmt: skip
            message = Message(message.stream, message.envelope, payload.model_copy(update={"segments": empty}))
        kept.append(message)
    return kept


def test_the_back_gives_contacts_and_strides_of_both_feet():
    outputs = run(BACK)
    events, strides = payloads(outputs, GaitEvent), payloads(outputs, Stride)
    assert len([event for event in events if event.kind is IC]) == pytest.approx(14.0 / (STRIDE_S / 2), abs=4)
    assert len(strides) >= 20
    assert all(stride.valid and stride.toe_off_ns is not None and stride.step_length_m is None for stride in strides)
    np.testing.assert_allclose([stride.stride_time_s for stride in strides], STRIDE_S, atol=0.03)
    np.testing.assert_allclose([stride.step_time_s for stride in strides], STRIDE_S / 2, atol=0.03)
    assert all(stride.curves == {} for stride in strides)


def test_feet_give_contacts_and_toe_offs():
    outputs = run(FEET)
    for side in Side:
        events = [event for event in payloads(outputs, GaitEvent) if event.side is side]
        contacts = np.array([event.captured_ns * 1e-9 for event in events if event.kind is IC])
        shift_s = STRIDE_S / 2 if side is Side.LEFT else 0.0
        phase = (contacts - 2.0 - shift_s - PARAMETERS.foot_contact_after_swing_s) / STRIDE_S
        np.testing.assert_allclose(phase, np.round(phase), atol=0.02)
        assert len(contacts) >= 11
        assert {event.time_std_s for event in events if event.kind is TO} == {PARAMETERS.foot_toe_off_std_s}
    assert all(stride.valid and stride.stance_fraction is not None for stride in payloads(outputs, Stride))


@pytest.mark.parametrize("worn", [BACK, FEET], ids=["back", "feet"])
@pytest.mark.parametrize("batch", [1, 7])
def test_batches_do_not_matter(worn, batch):
    assert plain(run(worn, stream(worn, batch))) == plain(run(worn))


@pytest.mark.parametrize("worn", [BACK, FEET], ids=["back", "feet"])
@pytest.mark.parametrize("seed", range(3))
def test_the_order_of_the_streams_does_not_matter(worn, seed):
    rng = random.Random(seed)
    queues = [[m for m in stream(worn) if m.stream == name] for name in (JOINTS_FROM, RHYTHM_FROM, MOTION_FROM)]
    merged = []
    while any(queues):
        queue = rng.choice([queue for queue in queues if queue])
        merged += queue[:9]
        del queue[:9]
    assert plain(run(worn, merged)) == plain(run(worn))


@pytest.mark.parametrize("worn", [BACK, FEET], ids=["back", "feet"])
@pytest.mark.parametrize("cut", [2, 350, 601])
def test_a_resumed_node_goes_on_alike(worn, cut):
    messages = stream(worn)
    first, resumed = node_of(worn), node_of(worn)
    outputs = [output for message in messages[:cut] for output in first.step(message)]
    resumed.restore(json.loads(json.dumps(first.snapshot())))
    outputs += [output for message in messages[cut:] for output in resumed.step(message)] + resumed.finish()
    assert plain(outputs) == plain(run(worn))


@pytest.mark.parametrize("worn", [BACK, FEET], ids=["back", "feet"])
def test_a_silence_of_the_sensor_spoils_the_strides_around_it(worn):
    strides = payloads(run(worn, without(stream(worn), 8.0, 8.6)), Stride)
    across = [s for s in strides if s.start_ns < 8.3e9 < s.end_ns]
    assert all(stride.rejected_because == SENSOR_MISSING for stride in across)
    later = [s for s in strides if s.start_ns > 10e9]
    assert len(later) >= 6
    assert all(stride.valid for stride in later)


def test_motion_that_never_comes_is_a_missing_sensor():
    lonely = [message for message in stream(BACK) if message.stream != MOTION_FROM]
    assert run(BACK, lonely) == []


def test_numbers_that_are_no_movement_are_counted():
    messages = list(stream(BACK))
    at = next(i for i, m in enumerate(messages) if m.stream == MOTION_FROM)
    payload = messages[at].payload
    [there] = payload.segments
    wild = there.model_copy(update={"acceleration": [[1e9, 0.0, 0.0], *there.acceleration[1:]]})
    ragged = there.model_copy(update={"angular_velocity": there.angular_velocity[1:]})
    for broken, lost in ((wild, 1), (ragged, len(there.captured_ns))):
        message = Message(MOTION_FROM, messages[at].envelope, payload.model_copy(update={"segments": [broken]}))
        node = node_of(BACK)
        run(BACK, [*messages[:at], message, *messages[at + 1 :]], node)
        [rejection] = node.rejections()
        assert (rejection.subject, rejection.reason, rejection.count) == (MOTION_FROM.name, Reason.OUT_OF_RANGE, lost)


def test_a_leg_with_a_shank_keeps_it_beside_the_back():
    """The back tells the leg without a sensor, and only that one."""
    worn = BACK | {Segment.SHANK_LEFT}
    events = payloads(run(worn, stream(BACK)), GaitEvent)
    assert {event.side for event in events if event.time_std_s == PARAMETERS.back_contact_std_s} == {Side.RIGHT}
