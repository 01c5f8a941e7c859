"""A camera as a session of ingest on a real bus: its own pace, its end, and a port that is free again."""

import dataclasses
import threading

import pytest

from schemas.session import SessionDescription
from schemas.signals import command_key
from schemas.skeleton import SkeletonBatch
from services.bus.connection import Bus
from services.bus.router import open_router
from services.bus.settings import BusSettings
from services.ingest.capture.parameters import CAPTURE
from services.ingest.capture.ports import CapturePorts
from services.ingest.capture.settings import CaptureSettings
from services.ingest.service import IngestService
from tests.scenarios.test_ingest_service import QUICK, SITE, Stage, wait_until
from tests.unit.ingest.capture.test_capture_source import Sender, free_port

pytestmark = pytest.mark.system

IMPATIENT = dataclasses.replace(
    CAPTURE, first_frame_s=1.5, look_s=0.2, sending_s=0.8, other_sender_s=0.3, warn_after_s=0.3, end_after_s=2.0
)


@pytest.fixture
def port():
    return free_port()


@pytest.fixture
def stage(port):
    ports = CapturePorts(CaptureSettings(skeleton_ports=[port]), IMPATIENT)
    stop = threading.Event()
    with open_router(BusSettings(router="tcp/127.0.0.1:0", site=SITE)) as router:
        settings = BusSettings(router=router.endpoint, site=SITE)
        with Bus.open(settings, "ingest") as bus, Bus.open(settings, "listener") as listener:
            service = IngestService(bus, stop, dataclasses.replace(QUICK, linger_s=0.5), ports)
            thread = threading.Thread(target=service.run)
            thread.start()
            stage = Stage(settings, listener, service)
            try:
                wait_until(lambda: listener.ask(command_key(SITE, "ingest", "sources"), timeout_s=0.5))
                wait_until(lambda: stage.order("sources", {})["devices"])
                yield stage
            finally:
                stage.close()
                stop.set()
                thread.join(20.0)
            assert not thread.is_alive()


def batches(stage, session="s1"):
    return [SkeletonBatch.model_validate_json(body) for _, _, body in stage.of(session) if body]


@pytest.mark.parametrize("speed", [1.0, 1000.0, None])
def test_a_device_sets_its_own_pace(stage, port, speed):
    with Sender(port, rate=50.0):
        description = SessionDescription.model_validate(stage.start(f"device:kinect?port={port}", speed=speed))
        wait_until(lambda: len(batches(stage)) >= 25)
        assert description.duration_s is None
        assert stage.order("stop", {"session": "s1"}) == {"session": "s1"}
        wait_until(lambda: stage.ends("s1") == 1)
    sequences = [envelope.sequence for _, envelope, _ in stage.of("s1")]
    assert sequences == list(range(len(sequences)))
    assert {len(batch.captured_ns) for batch in batches(stage)} == {1}
    assert all(envelope.captured_ns < 60e9 for _, envelope, _ in stage.of("s1"))


def test_frames_are_joined_when_it_is_asked_for(stage, port):
    with Sender(port):
        stage.start(f"device:kinect?port={port}", speed=1.0, ticks=3)
        wait_until(lambda: len(batches(stage)) >= 10)
        stage.order("stop", {"session": "s1"})
        wait_until(lambda: stage.ends("s1") == 1)
    lengths = [len(batch.captured_ns) for batch in batches(stage)]
    assert set(lengths[:-1]) == {3}
    assert lengths[-1] <= 3


def test_a_mark_goes_with_the_next_frame(stage, port):
    with Sender(port):
        stage.start(f"device:kinect?port={port}", speed=1.0)
        wait_until(lambda: len(batches(stage)) >= 10)
        given = stage.order("mark", {"session": "s1", "last_s": 1.0})
        wait_until(lambda: any(batch.marks for batch in batches(stage)))
    (mark,) = [mark for batch in batches(stage) for mark in batch.marks]
    assert mark.to_ns == pytest.approx(given["to_s"] * 1e9)


def test_a_silent_camera_ends_its_session_and_frees_the_port(stage, port):
    spec = f"device:kinect?port={port}"
    with Sender(port):
        stage.start(spec, speed=1.0)
        wait_until(lambda: len(batches(stage)) >= 10)
        assert "another session listens" in stage.start(spec, speed=1.0, session="s2")["error"]
        assert stage.start(spec, speed=1.0)["session"] == "s1", "the same order again is the same session"
        assert "runs already" in stage.start(spec, speed=2.0)["error"]
    wait_until(lambda: stage.ends("s1") == 1)
    assert "no frame of a Kinect came" in stage.start(spec, speed=1.0, session="s3")["error"]
    with Sender(port):
        assert "session" in stage.start(spec, speed=1.0, session="s4")
        wait_until(lambda: len(batches(stage, "s4")) >= 5)


def test_what_was_refused_leaves_the_port_free(stage, port):
    spec = f"device:kinect?port={port}"
    with Sender(port):
        assert "body_cekf" in stage.start(spec, speed=1.0, estimator="ekf")["error"]
        assert "session" in stage.start(spec, speed=1.0)
