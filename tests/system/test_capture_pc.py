"""A capture PC, an ingest and an archive as processes: what was sent is on the bus, in the archive and replayed."""

import json
import os
import socket
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

from schemas.health import Health
from schemas.signals import command_key, health_key
from schemas.skeleton import SkeletonBatch
from services.bus.connection import Bus
from services.bus.loop import EventLoop
from services.bus.settings import BusSettings
from services.cli import live
from services.cli.supervisor import Supervisor
from services.flow.raw_streams import raw_streams
from services.ingest.choices import Choices
from services.ingest.source import open_source
from tests.system.stage import wait_until

pytestmark = pytest.mark.system

SQUATS = "synthetic:squat?person=2&seed=5&drops=0"


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Clinic:
    """Services that run, somebody who listens, and a capture PC when one is wanted."""

    def __init__(self, settings, port, data):
        self.settings, self.port, self.data = settings, port, data
        self.bus = Bus.open(settings, "test")
        self.loop = EventLoop(self.bus)
        self.frames, self.healths, self.ended = [], [], 0
        self.bus.subscribe(health_key(settings.site, "ingest", "*"), lambda said: self.healths.append(said.payload))
        self.thread = threading.Thread(target=self.loop.run)
        self.thread.start()

    def ask(self, command, body):
        answers = self.bus.ask(
            command_key(self.settings.site, "ingest", command), body=json.dumps(body).encode(), timeout_s=20.0
        )
        return json.loads(answers[0].payload)

    def listen(self, description):
        (stream,) = raw_streams(description)
        self.loop.post(lambda: self.loop.receive(description.session, stream, None, self._take))

    def send(self, spec):
        """The command line as a process, as somebody would try it."""
        command = [sys.executable, "-m", "services.cli", "send-skeletons", spec, "--port", str(self.port)]
        return subprocess.Popen(command, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL, env=dict(os.environ))

    def health(self, session):
        said = [Health.model_validate_json(each) for each in self.healths]
        return [each for health in said for each in health.sessions if each.session == session]

    def close(self):
        self.loop.stop()
        self.thread.join(10.0)
        self.loop.close()
        self.bus.close()

    def _take(self, delivery):
        self.ended += delivery.envelope.final
        if delivery.payload:
            self.frames.append((delivery.envelope, SkeletonBatch.model_validate_json(delivery.payload)))


@pytest.fixture
def clinic(tmp_path, free_router):
    port = free_port()
    settings = BusSettings(router=free_router)
    environment = {"AMBULA_SKELETON_PORTS": f"[{port}]", "AMBULA_DATA_DIR": str(tmp_path)}
    with Supervisor(["archive", "ingest"], settings, environment=environment) as stack:
        stack.wait_until_ready(timeout_s=120)
        clinic = Clinic(settings, port, tmp_path)
        yield clinic
        clinic.close()


def test_from_the_capture_pc_to_the_bus_the_archive_and_back(clinic):
    wait_until(lambda: clinic.ask("sources", {})["devices"])
    (device,) = clinic.ask("sources", {})["devices"]
    assert device["name"] == f"device:kinect?port={clinic.port}"
    assert not device["sending"]

    capture_pc = clinic.send(SQUATS)
    try:
        wait_until(lambda: clinic.ask("sources", {})["devices"][0]["sending"], timeout_s=60.0)
        description = live.start_session(clinic.bus, device["name"], None, Choices(task="squat"))
        clinic.listen(description)
        wait_until(lambda: len(clinic.frames) >= 60, timeout_s=20.0)
        from_s, to_s = live.mark_standing(clinic.bus, description.session, 1.0)
        wait_until(lambda: len(clinic.frames) >= 90, timeout_s=20.0)
        lags = [time.time_ns() - description.started_unix_ns - clinic.frames[-1][0].captured_ns]
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
            stranger.sendto(b"garbage", ("127.0.0.1", clinic.port))
        wait_until(lambda: any(health.inputs[0].received >= 60 for health in clinic.health(description.session)))
        wait_until(lambda: b"unknown_sender" in clinic.healths[-1], timeout_s=20.0)
        live.stop_session(clinic.bus, description.session)
        wait_until(lambda: clinic.ended == 1)
    finally:
        capture_pc.terminate()
        capture_pc.wait(10)

    assert (description.origin, description.task, description.cameras[0].kind) == ("device", "squat", "kinect_v2")
    envelopes, batches = zip(*clinic.frames, strict=True)
    assert [envelope.sequence for envelope in envelopes] == list(range(len(envelopes)))
    assert {body for batch in batches for body in batch.body} <= {None, 1}
    assert_as_sent(batches)
    (mark,) = [mark for batch in batches for mark in batch.marks]
    assert (mark.from_ns / 1e9, mark.to_ns / 1e9) == pytest.approx((from_s, to_s))
    assert lags[0] < 1e9
    (counts,) = clinic.health(description.session)[-1].inputs
    assert (counts.stream, counts.lost, counts.duplicated) == ("skeleton/kinect", 0, 0)
    assert_archived(clinic.data / description.session, description, batches)


def assert_as_sent(batches):
    """Each frame followed is a frame of the simulation, in order, at its pace."""
    simulated = [message for message in open_source(SQUATS).messages() if message.stream.signal.name == "skeleton"]
    of_pelvis = {
        tuple(np.round(m.payload.position[0][0], 6)): m.captured_ns for m in simulated if m.payload.position[0][0]
    }
    followed = [batch for batch in batches if batch.body == [1]]
    assert len(followed) > 60
    times = [(batch.captured_ns[0], of_pelvis[tuple(np.round(batch.position[0][0], 6))]) for batch in followed]
    offsets = np.array([ours - theirs for ours, theirs in times]) * 1e-9
    assert np.ptp(offsets) < 0.05


def assert_archived(folder, description, batches):
    """The archive has the same messages, and replays them as a session."""
    stored = folder / "raw.mcap.part"  # sealed only when the services behind have had their say
    wait_until(lambda: len(replayed(stored)) >= len(batches), timeout_s=20.0)
    again = open_source(str(stored), session="again").describe()
    assert (again.cameras, again.task, again.estimator) == (description.cameras, "squat", description.estimator)
    assert replayed(stored) == list(batches)


def replayed(file):
    if not file.exists():
        return []
    messages = open_source(str(file), session="again").messages()
    return [message.payload for message in messages if message.stream.signal.name == "skeleton"]
