"""The whole chain in a plain loop under the faults of a clinic."""

import json
from functools import cache

import pytest

from schemas.checkpoint import Checkpoint
from schemas.gait import GaitEvent, Stride
from schemas.kinematics import Calibration, JointState, LivePose
from schemas.metrics import SessionMetrics
from schemas.vocabulary import LOWER_BODY, SensorState
from services.cli.assembly import build_chain
from services.faults.disturb import disturb
from services.faults.faults import Duplicated, HubGap, Reordered, SensorOff, SensorStuck, Spike
from services.faults.inject import inject
from services.flow.inbox import OrderedInbox
from services.flow.message import Message, encode_payload
from services.ingest.source import iter_messages, open_source

WALK = "synthetic:walk?speed=1.1&seed=3&duration=25"
OTHER = "synthetic:walk?speed=0.8&seed=4&duration=25"
DOFS = [freedom.name for freedom in LOWER_BODY]


@cache
def recorded(spec: str = WALK):
    source = open_source(spec)
    return source.describe(), tuple(message for message in iter_messages(source))


def imu_only(messages) -> list[Message]:
    return [message for message in messages if message.stream.signal.name == "imu"]


def sensors() -> list[str]:
    return [sensor.name for sensor in recorded()[0].hubs[0].sensors]


def run(messages, description=None) -> list[Message]:
    chain = build_chain(description or recorded()[0])
    return [produced for message in messages for produced in chain.push(message)]


def lines(produced: list[Message]) -> list[tuple[str, int, bytes]]:
    return [(m.stream.name, m.envelope.sequence, encode_payload(m.payload)) for m in produced]


def payloads(produced, model):
    return [message.payload for message in produced if isinstance(message.payload, model)]


@cache
def undisturbed() -> tuple[Message, ...]:
    return tuple(run(imu_only(recorded()[1])))


def test_the_walk_gives_strides_and_final_metrics():
    names = [message.stream.signal.name for message in undisturbed()]
    assert names.count("stride") >= 20
    final = [m for m in undisturbed() if m.stream.signal.name == "metrics" and m.payload]
    assert final[-1].payload.final
    assert [m.stream.signal.name for m in undisturbed() if m.envelope.final].count("metrics") == 1


def test_duplicates_and_disorder_change_nothing():
    inbox = OrderedInbox()
    delivered = disturb(imu_only(recorded()[1]), [Duplicated(0.1), Reordered(12)], seed=5)
    in_order = [m for message in delivered for _, m in inbox.accept(message.envelope, message)]
    assert inbox.counts.duplicated > 100
    assert lines(run(in_order)) == lines(undisturbed())


def test_two_patients_interleaved_equal_each_alone():
    (first, first_messages), (second, second_messages) = recorded(WALK), recorded(OTHER)
    chains = build_chain(first), build_chain(second)
    outputs: tuple[list[Message], list[Message]] = ([], [])
    for pair in zip(imu_only(first_messages), imu_only(second_messages), strict=False):
        for chain, message, output in zip(chains, pair, outputs, strict=True):
            output += chain.push(message)
    assert lines(outputs[0]) == lines(undisturbed())[: len(outputs[0])]
    assert lines(outputs[1]) == lines(run(imu_only(second_messages), second))[: len(outputs[1])]
    assert len(outputs[0]) > 1000


@pytest.mark.parametrize("split_s", [2.0, 8.0, 15.5])
def test_every_node_resumes_from_its_checkpoint_to_the_bit(split_s):
    description, messages = recorded()
    chain = build_chain(description)
    produced: list[Message] = []
    for message in imu_only(messages):
        if message.envelope.captured_ns >= split_s * 1e9 > message.envelope.captured_ns - 10_000_000:
            frozen = [host.checkpoint().model_dump_json() for host in chain.hosts]
            chain = build_chain(description)
            for host, text in zip(chain.hosts, frozen, strict=True):
                host.resume(Checkpoint.model_validate_json(text))
        produced += chain.push(message)
    assert lines(produced) == lines(undisturbed())


def samples_of(produced: list[Message]) -> dict[str, list]:
    """What was said, with the rows of joint_state laid end to end."""
    said: dict[str, list] = {}
    for message in produced:
        match message.payload:
            case JointState() as state:
                table = zip(state.captured_ns, state.position, state.position_std, state.velocity, strict=True)
                said.setdefault("joint_state", []).extend(table)
            case Stride() | GaitEvent() | Calibration() | SessionMetrics() as payload:
                said.setdefault(message.stream.name, []).append(payload)
    return said


@pytest.mark.parametrize("ticks", [2, 5])
def test_how_samples_share_messages_changes_no_number(ticks):
    """Ingest puts more ticks into a message when the machine is busy."""
    batched = imu_only(iter_messages(open_source(WALK), ticks))
    assert len(batched) < len(imu_only(recorded()[1])) / (ticks - 0.5)
    assert samples_of(run(batched)) == samples_of(list(undisturbed()))


FAULTS = {
    "off at start": [SensorOff("shank_left", 0.0, 60.0)],
    "off midway": [SensorOff("shank_left", 12.0, 14.0)],
    "pelvis off midway": [SensorOff("pelvis", 12.0, 14.0)],
    "stuck": [SensorStuck("thigh_right", 12.0, 13.0)],
    "spike": [Spike("shank_right", 12.0, 30.0, 150.0), Spike("pelvis", 13.0, -30.0, -150.0)],
    "silent receiver": [HubGap(12.0, 12.8)],
}


@pytest.mark.parametrize("name", FAULTS)
def test_damage_stays_finite_and_keeps_the_numbering(name):
    produced = run(inject(imu_only(recorded()[1]), sensors(), FAULTS[name]))
    for line in lines(produced):
        assert b"NaN" not in line[2]
        if line[2]:
            json.loads(line[2])
    states = [m for m in produced if m.stream.signal.name == "joint_state"]
    assert [m.envelope.sequence for m in states] == list(range(len(states)))
    for state in payloads(produced, JointState):
        assert max(abs(value) for row in state.position for value in row) < 20.0


def test_a_sensor_that_went_off_is_named_and_its_knee_is_not_valid():
    produced = run(inject(imu_only(recorded()[1]), sensors(), FAULTS["off midway"]))
    poses = [pose for pose in payloads(produced, LivePose) if 13.2e9 < pose.captured_ns < 13.9e9]
    assert poses
    for pose in poses:
        states = {status.sensor: status.state for status in pose.sensors}
        assert states["shank_left"] is SensorState.MISSING
        assert "knee_flexion_left" not in pose.angles
        assert "knee_flexion_right" in pose.angles
    after = [pose for pose in payloads(produced, LivePose) if pose.captured_ns > 16e9]
    assert all("knee_flexion_left" in pose.angles for pose in after)


@pytest.mark.parametrize("name", ["off midway", "stuck", "spike", "silent receiver"])
def test_the_angles_recover(name):
    """Three seconds after the fault the knees are where they would have been, within 3 degrees."""
    produced = run(inject(imu_only(recorded()[1]), sensors(), FAULTS[name]))
    knees = [DOFS.index("knee_flexion_left"), DOFS.index("knee_flexion_right")]

    def angles(messages):
        return {
            captured_ns: [row[knee] for knee in knees]
            for state in payloads(messages, JointState)
            for captured_ns, row in zip(state.captured_ns, state.position, strict=True)
            if captured_ns > 17e9
        }

    clean, damaged = angles(undisturbed()), angles(produced)
    assert len(damaged) > 500
    worst = max(abs(a - b) for t, row in damaged.items() for a, b in zip(row, clean[t], strict=True))
    assert worst < 0.053
