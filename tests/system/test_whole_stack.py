"""All services as real processes over Zenoh on loopback: same numbers as a plain loop, whatever is killed."""

import time
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

from schemas.imu import ImuBatch, ReferenceBatch
from schemas.kinematics import JointCentres, JointState
from schemas.metrics import SessionMetrics
from schemas.rhythm import Rhythm
from schemas.session import SessionDescription
from schemas.signals import IMU, SIGNALS
from schemas.skeleton import SkeletonBatch
from schemas.vocabulary import LOWER_BODY
from services.bus.connection import Bus
from services.bus.settings import BusSettings
from services.cli import live
from services.cli.assembly import build_chain
from services.cli.reprocess.recompute import open_archived, recompute
from services.cli.supervisor import Supervisor
from services.flow.message import Message, encode_payload
from services.flow.software import VERSION
from services.ingest.source import iter_messages, open_source
from services.recordings.reader import open_recording

pytestmark = pytest.mark.system

WALK = "synthetic:walk?speed=1.2&seed=11&duration=24"
KNEE = "synthetic:walk?speed=1.2&seed=12&duration=24&worn=1"
TIMED_UP_AND_GO = "synthetic:tug?seed=4&stroll=4"
SQUATS = "synthetic:squat?person=2&repetitions=4"
BOTH = "synthetic:walk?speed=1.2&seed=13&duration=24&camera=1"
SERVICES = ["archive", "estimation", "segmentation", "metrics", "ingest"]


@dataclass
class Stack:
    supervisor: Supervisor
    settings: BusSettings
    data: Path

    def play(self, spec: str, speed: float | None, victim: str | None = None) -> SessionDescription:
        """Play a source to its final metrics; the victim is killed once a third of it is done."""
        with Bus.open(self.settings, "test") as bus, live.Watch(bus) as watch:
            description = live.start_session(bus, spec, speed)
            deadline = time.monotonic() + 90
            for news in watch.follow(description):
                assert time.monotonic() < deadline
                if isinstance(news, SessionMetrics):
                    assert victim is None, f"{victim} was never killed"
                    return description
                if victim is not None and news > description.duration_s / 3:
                    self.supervisor.kill(victim)
                    victim = None
        raise AssertionError("the session never ended")

    def archived(self, session: str) -> dict[str, list[Message]]:
        """The archived messages by stream, once the archive has sealed the session."""
        folder = self.data / session
        deadline = time.monotonic() + 30
        while list(folder.glob("*.part")) or not (folder / "manifest.json").exists():
            assert time.monotonic() < deadline, sorted(folder.iterdir())
            time.sleep(0.1)
        streams: dict[str, list[Message]] = {}
        for message in open_recording(folder).messages():
            streams.setdefault(message.stream.name, []).append(message)
        return streams


@pytest.fixture(scope="module")
def stack(tmp_path_factory, free_router):
    data = tmp_path_factory.mktemp("recordings")
    settings = BusSettings(router=free_router)
    with Supervisor(SERVICES, settings, environment={"AMBULA_DATA_DIR": str(data)}) as supervisor:
        supervisor.wait_until_ready(timeout_s=120)
        yield Stack(supervisor, settings, data)


OF_ALL_ROWS = ("model", "valid", "observed", "seen", "marks")
"""Fields of a message that hold for each of its samples."""


def rows(messages: list[Message]) -> list[tuple]:
    """What the messages say, one row a sample: how many samples share a message depends on the load."""
    said: list[tuple] = []
    for message in messages:
        match message.payload:
            case None:
                continue
            case ImuBatch(sensors=sensors):
                for s, samples in enumerate(sensors):
                    values = zip(samples.captured_ns, samples.angular_velocity, samples.specific_force, strict=True)
                    said += [(captured_ns, s, gyro, force) for captured_ns, gyro, force in values]
            case JointState() | JointCentres() | Rhythm() | ReferenceBatch() | SkeletonBatch():
                fields = dict(message.payload)
                columns = [value for name, value in fields.items() if name not in OF_ALL_ROWS]
                said += [(*row, *(fields.get(name) for name in OF_ALL_ROWS)) for row in zip(*columns, strict=True)]
            case payload:
                said.append((encode_payload(payload),))
    return sorted(said) if message.stream.signal is IMU else said


@cache
def plain_loop(spec: str) -> dict[str, list[Message]]:
    source = open_source(spec)
    chain = build_chain(source.describe())
    streams: dict[str, list[Message]] = {}
    for message in iter_messages(source):
        for one in [message, *chain.push(message)]:
            streams.setdefault(one.stream.name, []).append(one)
    return streams


def first_difference(some: list[tuple], others: list[tuple]) -> int | None:
    """Row from which on they differ; a comparison by the test runner writes down all rows, for minutes."""
    pairs = enumerate(zip(some, others, strict=False))
    apart = next((k for k, (one, other) in pairs if one != other), min(len(some), len(others)))
    return None if apart == len(some) == len(others) else apart


def complete(stack: Stack, description: SessionDescription, spec: str) -> dict[str, list[Message]]:
    """The archived messages: every stream of a plain loop is there, without a hole, to its end."""
    archived = stack.archived(description.session)
    assert "gap/archive" not in archived
    for name, messages in plain_loop(spec).items():
        if messages[0].stream.signal.archived:
            assert [m.envelope.sequence for m in archived[name]] == list(range(len(archived[name]))), name
            assert archived[name][-1].envelope.final, name
    return archived


def same_as_plain_loop(stack: Stack, description: SessionDescription, spec: str) -> None:
    archived = complete(stack, description, spec)
    for name, messages in plain_loop(spec).items():
        if messages[0].stream.signal.archived:
            assert first_difference(rows(archived[name]), rows(messages)) is None, name


@pytest.fixture(scope="module", params=[WALK, SQUATS])
def played(stack, request) -> tuple[str, SessionDescription]:
    """A walk with sensors and squats before a camera, as fast as the services follow."""
    return request.param, stack.play(request.param, None)


def test_live_services_give_the_numbers_of_a_plain_loop(stack, played):
    spec, description = played
    same_as_plain_loop(stack, description, spec)


KILLED = [
    *((KNEE, victim) for victim in ("estimation", "segmentation", "metrics", "archive")),
    *((WALK, victim) for victim in ("estimation", "archive")),
    *((TIMED_UP_AND_GO, victim) for victim in ("segmentation", "metrics")),
    *((SQUATS, victim) for victim in ("estimation", "segmentation")),
]


@pytest.mark.parametrize(("spec", "victim"), KILLED)
def test_nothing_is_lost_when_a_service_is_killed(stack, spec, victim):
    """Two sensors of one leg, five of a walker, a task with phases, and a camera, each where it differs."""
    same_as_plain_loop(stack, stack.play(spec, 4.0, victim), spec)


def test_sensors_and_camera_lose_nothing_when_their_estimation_is_killed(stack):
    """Which of two sources is late decides rows, and four times as fast everything is late four times as soon; so
    the samples are those of a plain loop, and the rows are all there, once each and in order."""
    archived = complete(stack, stack.play(BOTH, 4.0, "estimation"), BOTH)
    expected = plain_loop(BOTH)
    for name in expected:
        if name.startswith(("imu/", "skeleton/", "reference/")):
            assert first_difference(rows(archived[name]), rows(expected[name])) is None, name
    times = [[row[0] for row in rows(streams["joint_state/estimation"])] for streams in (archived, expected)]
    assert times[0] == sorted(set(times[0]))
    assert abs(len(times[0]) - len(times[1])) < 0.05 * len(times[1])


def test_a_knee_has_its_angle_and_strides_a_timed_up_and_go_its_phases_and_squats_are_counted():
    """What the sessions above are about is there to be lost."""
    knee, timed = plain_loop(KNEE), plain_loop(TIMED_UP_AND_GO)
    flexion = [dof.name for dof in LOWER_BODY].index("knee_flexion_left")
    states = [m.payload for m in knee["joint_state/estimation"] if m.payload]
    assert sum(state.valid[flexion] for state in states) > 0.5 * len(states)
    assert len(knee["stride/segmentation"]) > 10
    assert len({m.payload.phase for m in timed["task_phase/segmentation"] if m.payload}) >= 5
    squats = plain_loop(SQUATS)
    assert len([m for m in squats["repetition/segmentation"] if m.payload]) >= 4
    assert sum(any(m.payload.seen) for m in squats["joint_centres/estimation"] if m.payload) > 100
    for streams in (knee, timed, squats):
        assert [m.payload.final for m in streams["metrics/metrics"] if m.payload][-1]


def test_two_patients_at_once_equal_each_alone(stack):
    other = "synthetic:walk?speed=0.8&seed=12&duration=24"
    with Bus.open(stack.settings, "test") as bus, live.Watch(bus) as watch:
        descriptions = [live.start_session(bus, spec, 4.0) for spec in (WALK, other)]
        for description in descriptions:
            assert any(isinstance(news, SessionMetrics) for news in watch.follow(description))
    same_as_plain_loop(stack, descriptions[0], WALK)
    same_as_plain_loop(stack, descriptions[1], other)


def test_an_archive_gives_its_own_results_again(stack, played):
    """Recomputed from the raw file: every derived message, to the byte, under the same numbers."""
    _, description = played
    archived = stack.archived(description.session)
    source = open_source(str(stack.data / description.session))
    chain = build_chain(source.describe())
    again: dict[str, list[Message]] = {}
    for message in iter_messages(source):
        for produced in chain.push(message):
            if produced.stream.signal.archived:
                again.setdefault(produced.stream.name, []).append(produced)
    assert len(again) == sum(signal.archived == "derived" for signal in SIGNALS)
    for name, messages in again.items():
        assert messages == archived[name], name


def test_reprocessing_what_the_same_software_archived_says_identical(stack, played):
    _, description = played
    stack.archived(description.session)
    result = recompute(open_archived(stack.data / description.session))
    assert (result.stored_version, result.same_software) == (VERSION, True)
    assert (result.same_messages, result.differing, result.notes) == (True, [], [])
    assert result.stored == result.metrics
    assert result.metrics.final
