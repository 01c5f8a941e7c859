"""Walks before a camera through the node: events, strides, steps; on a floor and on a treadmill; node rules."""

import json
import random

import numpy as np
import pytest

from schemas.gait import GaitEvent, Stride
from schemas.vocabulary import GaitEventKind, Side
from services.bench.exercises.seen_walks import CENTRES, JOINTS, RHYTHMS, seen_walk
from services.flow.message import Message
from services.segmentation.gait.strides import GAP, OUT_OF_VIEW
from services.segmentation.node import build

WALK = "speed=1.1&seed=3&duration=25"


def walk(query=WALK, *, treadmill=True, noise_m=0.01, seed=1):
    return seen_walk(query, treadmill=treadmill, noise_m=noise_m, offset_m=0.01, seed=seed)


def run(messages, node=None):
    node = node or build(walk().description())
    return [output for message in messages for output in node.step(message)] + node.finish()


def plain(outputs):
    return [(output.signal.name, output.captured_ns, output.payload.model_dump_json()) for output in outputs]


def strides(outputs):
    return [output.payload for output in outputs if isinstance(output.payload, Stride)]


@pytest.fixture(scope="module")
def messages():
    return walk().messages()


@pytest.fixture(scope="module")
def expected(messages):
    return plain(run(messages))


@pytest.mark.parametrize("treadmill", [True, False])
@pytest.mark.parametrize(("speed", "asymmetry"), [(0.6, 0.0), (0.9, 0.2), (1.3, 0.0)])
def test_events_and_strides_are_those_of_the_walk(treadmill, speed, asymmetry):
    seen = walk(f"speed={speed}&asymmetry={asymmetry}&seed=2&duration=30", treadmill=treadmill)
    outputs = run(seen.messages(), build(seen.description()))
    for kind, true_of in ((GaitEventKind.INITIAL_CONTACT, "contacts_s"), (GaitEventKind.TOE_OFF, "toe_offs_s")):
        for side in Side:
            true = getattr(seen.walk, true_of)(side)[1:-1]
            told = [output.payload for output in outputs if isinstance(output.payload, GaitEvent)]
            found = np.array([one.captured_ns / 1e9 for one in told if one.side is side and one.kind is kind])
            errors = np.array([found[np.argmin(abs(found - at))] - at for at in true])
            assert np.max(abs(errors)) < 0.12
            assert abs(np.mean(errors)) < 0.03
            assert abs(len(found) - len(true)) <= 2
    counted = [stride for stride in strides(outputs) if stride.valid]
    assert np.mean([stride.walking_speed for stride in counted[2:-2]]) == pytest.approx(speed, rel=0.04)
    for stride in counted:
        assert {"hip_flexion_left", "trunk_flexion"} <= set(stride.curves)
        assert "knee_adduction_left" not in stride.curves


@pytest.mark.parametrize("rows", [3, 8])
def test_batches_do_not_matter(rows, expected):
    assert plain(run(walk().messages(rows))) == expected


@pytest.mark.parametrize("seed", range(2))
def test_the_order_of_the_streams_does_not_matter(seed, messages, expected):
    rng = random.Random(seed)
    streams = [[m for m in messages if m.stream == stream] for stream in (JOINTS, RHYTHMS, CENTRES)]
    merged = []
    while any(streams):
        source = rng.choice([stream for stream in streams if stream])
        merged += source[:15]
        del source[:15]
    assert plain(run(merged)) == expected


@pytest.mark.parametrize("cut", [1, 400, 777, 1500])
def test_split_and_resume(cut, messages, expected):
    first, second = build(walk().description()), build(walk().description())
    outputs = [output for message in messages[:cut] for output in first.step(message)]
    second.restore(json.loads(json.dumps(first.snapshot(), allow_nan=False)))
    assert second.snapshot() == first.snapshot()
    assert plain(outputs + run(messages[cut:], second)) == expected


def test_two_sessions_interleaved_are_each_alone(messages, expected):
    other = walk("speed=0.7&seed=5&duration=25", treadmill=False).messages()
    nodes, outputs = (build(walk().description()), build(walk().description())), ([], [])
    for number in range(max(len(messages), len(other))):
        for node, given, output in zip(nodes, (messages, other), outputs, strict=True):
            output += node.step(given[number]) if number < len(given) else []
    for node, output in zip(nodes, outputs, strict=True):
        output += node.finish()
    assert plain(outputs[0]) == expected
    assert plain(outputs[1]) == plain(run(other))


def test_a_leg_out_of_view_costs_its_strides_alone(messages):
    hidden = []
    for message in messages:
        payload = message.payload
        if message.stream == CENTRES and 10e9 < payload.captured_ns[0] < 11e9:
            payload = payload.model_copy(update={"seen": [*payload.seen[:-1], False]})
        hidden.append(Message(message.stream, message.envelope, payload))
    found = strides(run(hidden))
    unseen = [stride for stride in found if stride.rejected_because == OUT_OF_VIEW]
    assert unseen
    assert {stride.side for stride in unseen} == {Side.LEFT}
    assert any(stride.valid and stride.start_ns > 12e9 and stride.side is Side.LEFT for stride in found)


def test_frames_that_never_came_cost_the_strides_around_them(messages):
    fewer = [message for message in messages if not 10e9 < message.envelope.captured_ns < 10.5e9]
    reasons = {stride.rejected_because for stride in strides(run(fewer))}
    assert GAP in reasons


def test_without_joint_centres_there_is_no_gait(messages):
    assert run([message for message in messages if message.stream != CENTRES]) == []
