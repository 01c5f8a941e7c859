"""A leg of which only the shank is known."""

import json

import numpy as np
import pytest

from schemas.gait import GaitEvent, Stride
from schemas.kinematics import JointState
from schemas.vocabulary import LOWER_BODY, GaitEventKind, Segment, Side
from services.bench.gait.joint_walks import joint_walk
from services.flow.message import Message
from services.segmentation.gait.lone_swing import ShankSwingDetector
from services.segmentation.gait.strides import SENSOR_MISSING
from services.segmentation.node import build
from services.segmentation.parameters import SegmentationParameters

PARAMETERS = SegmentationParameters()
IC, TO = GaitEventKind.INITIAL_CONTACT, GaitEventKind.TOE_OFF
NOTHING_VALID = (False,) * len(LOWER_BODY)
SHANKS = (Segment.SHANK_LEFT, Segment.SHANK_RIGHT)


def swinging(rate_hz: float, seconds: float = 12.0, stride_s: float = 1.2, offset_s: float = 0.0):
    """(ns, rad/s) of a shank that turns forward in the second half of each stride."""
    time_s = np.arange(offset_s, seconds, 1 / rate_hz)
    return [(round(t * 1e9), float(-2.5 * np.sin(2 * np.pi * t / stride_s))) for t in time_s]


@pytest.mark.parametrize("rate_hz", [40.0, 100.0])
@pytest.mark.parametrize("offset_s", [0.0, 0.0034])
def test_events_lie_a_constant_beside_the_zeros_of_the_rate(rate_hz, offset_s):
    detector = ShankSwingDetector(PARAMETERS)
    found = [(ns, detector.step(ns, rate, 0.0, False)) for ns, rate in swinging(rate_hz, offset_s=offset_s)]
    events = [(ns, event) for ns, event in found if event is not None]
    contacts = np.array([event.captured_ns * 1e-9 for _, event in events if event.kind is IC])
    lifts = np.array([event.captured_ns * 1e-9 for _, event in events if event.kind is TO])
    wanted = np.arange(1, len(contacts) + 1) * 1.2
    assert len(contacts) == 9
    np.testing.assert_allclose(contacts, wanted + PARAMETERS.shank_contact_after_swing_s, atol=2e-3)
    np.testing.assert_allclose(lifts[:9], wanted - 0.6 - PARAMETERS.shank_toe_off_before_swing_s, atol=2e-3)
    assert all(event.captured_ns <= ns for ns, event in events)
    assert all(ns - event.captured_ns <= 1.001e9 / rate_hz for ns, event in events if event.kind is IC)


def test_a_slowly_turning_other_leg_does_not_hide_a_swing():
    detector = ShankSwingDetector(PARAMETERS)
    for ns in range(0, 2_000_000_000, 10_000_000):
        detector.step(ns, 0.3, 0.0, False)
    assert not detector.rotating


def with_sensors(query: str, segments: tuple[Segment, ...], silent_s: tuple[float, float] = (0.0, 0.0)):
    """A walk, its description with sensors on these segments only, and what estimation says of it.

    No joint is valid. The first of the segments is not observed between the two times.
    """
    walk = joint_walk(query)
    hubs = [
        hub.model_copy(update={"sensors": [sensor for sensor in hub.sensors if sensor.segment in segments]})
        for hub in walk.description.hubs
    ]
    messages = []
    for message in walk.track.messages(valid=NOTHING_VALID):
        payload = message.payload
        if isinstance(payload, JointState):
            silent = silent_s[0] <= payload.captured_ns[0] * 1e-9 < silent_s[1]
            payload = payload.model_copy(update={"observed": list(segments[1:] if silent else segments)})
        messages.append(Message(message.stream, message.envelope, payload))
    return walk, walk.description.model_copy(update={"hubs": hubs}), messages


def run(description, messages, cut: int | None = None):
    node, outputs = build(description), []
    for number, message in enumerate(messages):
        if number == cut:
            kept = json.loads(json.dumps(node.snapshot()))
            node = build(description)
            node.restore(kept)
        outputs += node.step(message)
    return [output.payload for output in outputs + node.finish()]


WALK = "speed=1.1&seed=3&duration=20"


def test_shanks_alone_give_events_and_strides_without_angles():
    walk, description, messages = with_sensors(WALK, SHANKS)
    found = run(description, messages)
    strides = [payload for payload in found if isinstance(payload, Stride)]
    for side in Side:
        events = [e.captured_ns * 1e-9 for e in found if isinstance(e, GaitEvent) and (e.side, e.kind) == (side, IC)]
        assert abs(len(events) - len(walk.contacts_s(side))) <= 1
    assert len(strides) > 15
    assert all(stride.valid and not stride.curves and stride.step_length_m is None for stride in strides)
    assert all(stride.stance_fraction is not None for stride in strides)


def test_split_and_resume_with_shanks_alone():
    _, description, messages = with_sensors(WALK, SHANKS)
    assert run(description, messages, cut=523) == run(description, messages)


def test_a_silent_shank_rejects_the_strides_around_the_silence():
    _, description, messages = with_sensors(WALK, SHANKS, silent_s=(10.0, 11.0))
    strides = [p for p in run(description, messages) if isinstance(p, Stride)]
    for stride in strides:
        touched = stride.start_ns < 11.0e9 and stride.end_ns > 10.0e9
        if stride.side is Side.LEFT:
            assert stride.rejected_because == (SENSOR_MISSING if touched else None)
        else:
            assert stride.valid


@pytest.mark.parametrize("others", [(), (Segment.THIGH_RIGHT,), (Segment.PELVIS,)])
def test_one_shank_gives_strides_of_one_leg(others):
    _, description, messages = with_sensors(WALK, (Segment.SHANK_RIGHT, *others))
    found = run(description, messages)
    sides = {payload.side for payload in found if isinstance(payload, GaitEvent | Stride)}
    assert sides == {Side.RIGHT}
    assert any(payload.valid for payload in found if isinstance(payload, Stride))


def test_no_shank_no_events():
    _, description, messages = with_sensors(WALK, (Segment.PELVIS, Segment.THIGH_LEFT))
    assert run(description, messages) == []
