"""The archive as a process on a real bus: killed, starved of disk, started late; nothing may be missing afterwards."""

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from random import random

import pytest

from schemas.archive_layout import Manifest, RecordingState
from schemas.checkpoint import Checkpoint
from schemas.health import Health, Progress, Reason
from schemas.imu import ImuBatch, SensorSamples
from schemas.session import Anthropometry, HubDescription, SessionDescription
from schemas.signals import (
    IMU,
    SIGNALS,
    checkpoint_key,
    command_key,
    description_key,
    health_key,
    progress_key,
    session_token_key,
)
from services.bus.connection import Bus, RemoteError
from services.bus.publisher import StreamPublisher
from services.bus.received import Received
from services.bus.router import choose_endpoint, open_router
from services.bus.settings import BusSettings
from services.flow.message import Envelope, Stream
from services.recordings.folder import verify
from services.recordings.reader import open_recording

pytestmark = pytest.mark.system
HUB = Stream(IMU, "hub")
COMPUTED = [Stream(each, each.producer) for each in SIGNALS if each.archived == "derived"]
RATE_HZ = 100


@pytest.fixture
def settings():
    return BusSettings(router=choose_endpoint("tcp/127.0.0.1:0"), site="test")


@pytest.fixture
def router(settings):
    with open_router(settings) as router:
        yield router


@pytest.fixture
def bus(settings, router):
    with Bus.open(settings, "test") as bus:
        yield bus


def until(condition, timeout_s=20.0):
    deadline = time.monotonic() + timeout_s
    while not (result := condition()):
        assert time.monotonic() < deadline, "it never came"
        time.sleep(0.02)
    return result


def answers(bus, key):
    """None as long as the one who is asked is still starting."""
    try:
        return bus.ask(key)
    except RemoteError:
        return []


class Patient:
    """A session whose streams are all published from here: the hub's and, in step with it, everything computed."""

    def __init__(self, bus, session):
        self.bus = bus
        self.description = describe(session)
        self.sent = dict.fromkeys((HUB, *COMPUTED), 0)
        site = bus.settings.site
        self.publishers = {stream: StreamPublisher(bus, session, stream) for stream in self.sent}
        self.handles = [
            bus.serve(description_key(site, session), lambda key, *_: [Received(key, b"", self.text.encode())]),
            bus.declare_token(session_token_key(site, session)),
        ]
        self.progress = {}
        self.handles.append(bus.subscribe(progress_key(site, session, "archive"), self._hear))

    @property
    def text(self):
        return self.description.model_dump_json()

    def _hear(self, received):
        self.progress = Progress.model_validate_json(received.payload).positions

    def walk(self, seconds):
        """In real time."""
        begin = time.monotonic()
        for tick in range(int(seconds * RATE_HZ)):
            self.step()
            time.sleep(max(0.0, begin + (tick + 1) / RATE_HZ - time.monotonic()))

    def step(self):
        for stream, number in self.sent.items():
            if stream in (HUB, *COMPUTED[1:3]) or number == 0:
                self._send(stream, number)

    def end(self):
        for stream, number in self.sent.items():
            self.publishers[stream].end(number * 10**7)
            self.sent[stream] += 1

    def leave(self):
        for handle in self.handles:
            handle.close()
        for publisher in self.publishers.values():
            publisher.close()

    def _send(self, stream, number):
        samples = SensorSamples(
            captured_ns=[number * 10**7],
            angular_velocity=[[random(), random(), number]],
            specific_force=[[0.0, 9.81, 0.0]],
        )
        payload = ImuBatch(sensors=[samples], marks=[]).model_dump_json().encode()
        self.publishers[stream].send_encoded(Envelope(0, number, number * 10**7), payload)
        self.sent[stream] += 1

    def is_safe(self):
        return all(self.progress.get(stream.name) == count - 1 for stream, count in self.sent.items())


def describe(session):
    return SessionDescription(
        session=session,
        title="a walk",
        started_unix_ns=time.time_ns(),
        origin="synthetic",
        protocol="walk",
        estimator="ekf",
        walk_path="turning",
        hubs=[HubDescription(name="hub", sensors=[])],
        anthropometry=Anthropometry(
            height_m=1.7, mass_kg=70.0, thigh_length_m=0.4, shank_length_m=0.4, hip_width_m=0.2, source="default"
        ),
        standing=[],
        reference=[],
        duration_s=None,
    )


@contextmanager
def archive(settings, data_dir, limit_bytes=None):
    """The archive as its own process."""
    environment = {
        **os.environ,
        "AMBULA_ROUTER": settings.router,
        "AMBULA_SITE": settings.site,
        "AMBULA_DATA_DIR": str(data_dir),
    }
    command = [sys.executable, "-m", "services.archive"]
    if limit_bytes is not None:
        command = ["prlimit", f"--fsize={limit_bytes}", *command]
    process = subprocess.Popen(command, env=environment)
    try:
        yield process
    finally:
        process.kill()
        process.wait()


def manifest_of(data_dir, session):
    path = data_dir / session / "manifest.json"
    return Manifest.model_validate_json(path.read_bytes()) if path.exists() else None


def is_closed(data_dir, session, state):
    manifest = manifest_of(data_dir, session)
    return manifest is not None and manifest.state is state


def numbers(data_dir, session):
    """Sequence numbers of every stream of a recording, gaps included as themselves."""
    found = {}
    for record in open_recording(data_dir / session).records():
        found.setdefault(record.stream.name, []).append(record.envelope.sequence)
    return found


def everything(patient):
    return {stream.name: list(range(count)) for stream, count in patient.sent.items()}


def test_a_session_is_recorded_from_beginning_to_end(bus, settings, tmp_path):
    patient = Patient(bus, "s1")
    patient.walk(0.5)
    with archive(settings, tmp_path):
        patient.walk(1.0)
        patient.end()
        until(patient.is_safe)
        until(lambda: is_closed(tmp_path, "s1", RecordingState.FINISHED))
        assert numbers(tmp_path, "s1") == everything(patient)
        assert verify(tmp_path / "s1") == []
        (listed,) = json.loads(bus.ask(command_key("test", "archive", "sessions"))[0].payload)
        assert Manifest.model_validate(listed) == manifest_of(tmp_path, "s1")
        assert listed["state"] == "finished"
    patient.leave()


@pytest.mark.parametrize("walked_s", [0.3, 0.9, 1.7])
def test_killed_while_recording_and_started_again_nothing_is_missing(bus, settings, tmp_path, walked_s):
    patient = Patient(bus, "s1")
    with archive(settings, tmp_path) as process:
        until(lambda: patient.progress or patient.walk(0.05))
        patient.walk(walked_s)
        process.send_signal(signal.SIGKILL)
        process.wait()
        promised = dict(patient.progress)
    held = numbers(tmp_path, "s1")
    assert all(held[name][-1] >= sequence for name, sequence in promised.items())
    assert all(found == list(range(len(found))) for found in held.values())
    patient.walk(0.7)
    with archive(settings, tmp_path):
        patient.walk(1.0)
        patient.end()
        until(patient.is_safe)
        until(lambda: is_closed(tmp_path, "s1", RecordingState.FINISHED))
    assert numbers(tmp_path, "s1") == everything(patient)
    assert verify(tmp_path / "s1") == []
    assert not list((tmp_path / "s1").glob("*.part*"))
    patient.leave()


def test_stopped_in_order_and_started_again_after_the_end(bus, settings, tmp_path):
    patient = Patient(bus, "s1")
    with archive(settings, tmp_path) as process:
        until(lambda: patient.progress or patient.walk(0.05))
        process.terminate()
        assert process.wait(10) == 0
    patient.walk(0.5)
    patient.end()
    with archive(settings, tmp_path):
        until(patient.is_safe)
        until(lambda: is_closed(tmp_path, "s1", RecordingState.FINISHED))
    assert numbers(tmp_path, "s1") == everything(patient)
    with archive(settings, tmp_path):
        patient.progress = {}
        until(patient.is_safe)
    patient.leave()


def test_a_full_disk_stops_the_recording_not_the_service(bus, settings, tmp_path):
    """Files may not grow over 40 kB: each time the limit is met the recording goes on in the next file."""
    heard = []
    bus.subscribe(health_key("test", "archive", "*"), lambda received: heard.append(received.payload))
    patient = Patient(bus, "s1")
    with archive(settings, tmp_path, limit_bytes=40_000) as process:
        until(lambda: patient.progress or patient.walk(0.05))
        patient.walk(8.0)
        patient.end()
        until(patient.is_safe, 40)
        assert process.poll() is None
    assert len(list((tmp_path / "s1").glob("raw_*"))) > 1
    assert numbers(tmp_path, "s1") == everything(patient)
    reasons = {
        item.reason
        for data in heard
        for session in Health.model_validate_json(data).sessions
        for item in session.rejections
    }
    assert Reason.NOT_RECORDED in reasons
    patient.leave()


def test_two_sessions_and_a_session_that_never_ends(bus, settings, tmp_path):
    first, second = Patient(bus, "s1"), Patient(bus, "s2")
    with archive(settings, tmp_path) as process:
        until(lambda: (first.progress and second.progress) or first.walk(0.05) or second.walk(0.05))
        first.walk(0.3)
        second.walk(0.3)
        first.end()
        second.leave()
        until(first.is_safe)
        process.kill()
        process.wait()
    with archive(settings, tmp_path):
        until(lambda: is_closed(tmp_path, "s1", RecordingState.FINISHED))
        until(lambda: is_closed(tmp_path, "s2", RecordingState.INTERRUPTED))
    assert numbers(tmp_path, "s1") == everything(first)
    held = numbers(tmp_path, "s2")
    assert all(found == list(range(len(found))) for found in held.values())
    assert set(held) == set(everything(second))
    first.leave()


def test_a_router_that_goes_and_comes_back_costs_nothing(settings, tmp_path):
    router = open_router(settings)
    with Bus.open(settings, "test") as bus, archive(settings, tmp_path):
        patient = Patient(bus, "s1")
        until(lambda: patient.progress or patient.walk(0.05))
        router.close()
        patient.walk(1.0)
        with open_router(settings):
            patient.walk(1.0)
            patient.end()
            until(patient.is_safe, 40)
            until(lambda: is_closed(tmp_path, "s1", RecordingState.FINISHED))
            patient.leave()
            bus.close()
    assert numbers(tmp_path, "s1") == everything(patient)


def test_a_second_archive_leaves_the_folder_alone(settings, router, tmp_path):
    with archive(settings, tmp_path) as first:
        until((tmp_path / ".archive.lock").exists)
        with archive(settings, tmp_path) as second:
            assert second.wait(20) == 1
        assert first.poll() is None


def test_checkpoints_are_kept_across_a_restart(bus, settings, tmp_path):
    key = checkpoint_key("test", "s1", "estimation")
    checkpoint = Checkpoint(
        service="estimation", session="s1", captured_ns=5, inputs={}, outputs={}, state={"x": [1.5]}
    )
    data = checkpoint.model_dump_json().encode()
    with archive(settings, tmp_path):
        until(lambda: bus.put(key, data) or bus.ask(key))
        until((tmp_path / "s1" / "checkpoint-estimation.json").exists)
    assert bus.ask(key) == []
    with archive(settings, tmp_path):
        assert until(lambda: answers(bus, key))[0].payload == data
        assert bus.ask(checkpoint_key("test", "s2", "estimation")) == []


def test_what_nobody_has_is_written_and_told_as_a_gap(bus, settings, tmp_path):
    patient = Patient(bus, "s1")
    with archive(settings, tmp_path):
        until(lambda: patient.progress or patient.walk(0.05))
        newest = patient.sent[HUB]
        patient.sent[HUB] += 3
        patient.walk(0.2)
        until(lambda: patient.progress.get(HUB.name, 0) >= newest + 3 or patient.walk(0.05))
        patient.end()
        until(patient.is_safe)
        until(lambda: is_closed(tmp_path, "s1", RecordingState.FINISHED))
    records = list(open_recording(tmp_path / "s1").records())
    (gap,) = [json.loads(record.payload) for record in records if record.stream.name == "gap/archive"]
    assert (gap["first_sequence"], gap["last_sequence"]) == (newest, newest + 2)
    patient.leave()


def test_an_erased_session_is_gone_and_stays_away(bus, settings, tmp_path):
    """While it is recorded it is left alone; after that it is not recorded again, although its token is still there."""
    key = command_key("test", "archive", "erase")

    def erase(*sessions):
        return json.loads(bus.ask(key, body=json.dumps({"sessions": sessions}).encode())[0].payload)["erased"]

    patient, other = Patient(bus, "s1"), Patient(bus, "s2")
    with archive(settings, tmp_path):
        until(lambda: (patient.progress and other.progress) or patient.walk(0.05) or other.walk(0.05))
        assert erase("s1", "unknown", "../s2") == ["unknown"]
        patient.end()
        until(lambda: is_closed(tmp_path, "s1", RecordingState.FINISHED))
        data = Checkpoint(service="metrics", session="s1", captured_ns=5, inputs={}, outputs={}, state={})
        bus.put(checkpoint_key("test", "s1", "metrics"), data.model_dump_json().encode())
        until(lambda: erase("s1") == ["s1"])
        patient.handles.append(bus.declare_token(session_token_key("test", "s1")))
        bus.put(checkpoint_key("test", "s1", "metrics"), data.model_dump_json().encode())
        before = other.progress
        until(lambda: other.progress != before or other.walk(0.05))
        assert not any(path.name.endswith("s1") for path in tmp_path.iterdir())
        assert (tmp_path / "s2").is_dir()
    patient.leave()
    other.leave()
