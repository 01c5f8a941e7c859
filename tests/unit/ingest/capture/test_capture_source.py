"""A port on loopback, and a session on it."""

import dataclasses
import json
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from schemas.health import Reason
from schemas.vocabulary import CameraKind, Task
from services.ingest.capture.first_look import NothingArrives, view_of_frames
from services.ingest.capture.parameters import CAPTURE
from services.ingest.capture.port import PortUnavailable
from services.ingest.capture.ports import CapturePorts
from services.ingest.capture.settings import CaptureSettings
from services.ingest.choices import Choices
from services.ingest.driver import LiveSource
from services.ingest.errors import InvalidOption, SourceError, WrongAxes, WrongUnits
from services.ingest.source import open_chosen
from tests.unit.ingest.capture.datagrams import datagram, decoded_frames, joints

README = Path(__file__).parents[4] / "services" / "ingest" / "README.md"
QUICK = dataclasses.replace(CAPTURE, first_frame_s=2.0, look_s=0.2, sending_s=1.0, other_sender_s=0.3)


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_until(condition, timeout_s=10.0):
    end = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < end, f"not within {timeout_s} s"
        time.sleep(0.005)


class Sender:
    """A capture PC: sends frames at a rate until it is closed."""

    def __init__(self, port, rate=100.0, first=0, **more):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.target = ("127.0.0.1", port)
        self.seq = first
        self.more = more
        self.stopped = threading.Event()
        self.thread = threading.Thread(target=self._run, args=(rate,))
        self.thread.start()

    def send(self, data):
        self.socket.sendto(data, self.target)

    def close(self):
        self.stopped.set()
        self.thread.join()
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _run(self, rate):
        while not self.stopped.wait(1 / rate):
            self.send(datagram(self.seq, t_us=time.monotonic_ns() // 1000, **self.more))
            self.seq += 1


@pytest.fixture
def port():
    return free_port()


@pytest.fixture
def ports(port):
    made = CapturePorts(CaptureSettings(skeleton_ports=[port]), QUICK)
    yield made
    made.close()


def opened(port, ports, options="", **choices):
    return open_chosen(f"device:kinect?port={port}{options}", Choices(**choices), session="s1", ports=ports)


def taken(source):
    out = []
    while source.peek() is not None:
        out.append(source.pop())
    return out


def refused_at(ports):
    return {rejection.reason: rejection.count for rejection in ports.rejections()}


def test_a_session_says_what_it_is(port, ports):
    with Sender(port, floor=[0.0, 1.0, 0.0, 0.95]):
        source = opened(port, ports, "&height=1.6", task=Task.SQUAT)
        description = source.describe()
        source.close()
    assert isinstance(source, LiveSource)
    assert (description.origin, description.duration_s, description.task) == ("device", None, "squat")
    assert (description.estimator, description.hubs) == ("body_cekf", [])
    (camera,) = description.cameras
    assert (camera.name, camera.kind, camera.rate_hz) == ("kinect", "kinect_v2", 30.0)
    assert camera.floor_m == pytest.approx(-0.95)
    assert description.anthropometry.source == "regression"
    assert description.anthropometry.thigh_length_m == pytest.approx(0.245 * 1.6)
    assert abs(description.started_unix_ns - time.time_ns()) < 20e9


def test_frames_come_by_themselves_from_now_on(port, ports):
    with Sender(port):
        source = opened(port, ports)
        began = time.monotonic()
        wait_until(lambda: source.counts()[0].received >= 20)
        passed_ns = (time.monotonic() - began) * 1e9
        messages = taken(source)
        assert not source.is_empty
        source.close()
    assert source.is_empty
    assert len(messages) >= 20
    assert 0 <= messages[0].captured_ns < 2e9
    assert messages[-1].captured_ns <= passed_ns + 1e9
    assert {message.payload.people[0] for message in messages} == {1}
    source.close()


def test_a_plain_loop_ends_when_told(port, ports):
    with Sender(port):
        source = opened(port, ports)
        got = []
        for message in source.messages():
            got.append(message)
            if len(got) == 10:
                source.stop()
        assert len(got) >= 10
        timed = opened(port, ports, "&duration=1")
        assert timed.describe().duration_s == 1.0
        began = time.monotonic()
        assert len(list(timed.messages())) > 5
        assert 0.9 < time.monotonic() - began < 15.0


def test_silence_is_told_and_at_last_the_end(port, caplog):
    patience = dataclasses.replace(QUICK, warn_after_s=0.3, end_after_s=2.0)
    ports = CapturePorts(CaptureSettings(skeleton_ports=[]), patience)
    with Sender(port):
        source = opened(port, ports)
        wait_until(lambda: source.peek() is not None)
    wait_until(lambda: "camera_silent" in caplog.text)
    taken(source)
    assert not source.is_empty
    with Sender(port, first=1000):
        wait_until(lambda: source.peek() is not None)
    wait_until(lambda: taken(source) == [] and source.is_empty)
    assert "camera_gone" in caplog.text
    assert caplog.text.count("camera_silent") >= 2
    source.close()
    ports.close()


def test_nothing_arrives(port, ports):
    with pytest.raises(NothingArrives, match=rf"port {port} within 2 s. Start the sender") as refused:
        opened(port, ports)
    assert "refused" not in str(refused.value)
    with Sender(port, bodies=[{"id": 1, "joints": joints()[:20]}]), pytest.raises(NothingArrives, match="20 joints"):
        opened(port, ports)


def test_a_person_that_is_none_is_refused(port, ports):
    flipped = [{"id": 1, "joints": [[x, -y, z, state] for x, y, z, state in joints()]}]
    with Sender(port, bodies=flipped), pytest.raises(WrongAxes, match="capture PC"):
        opened(port, ports)
    small = [{"id": 1, "joints": [[x / 100, y / 100, z / 100, state] for x, y, z, state in joints()]}]
    with pytest.raises(WrongUnits, match="capture PC"):
        view_of_frames(decoded_frames(5, bodies=small))
    with pytest.raises(WrongAxes, match=r"up.*floor"):
        view_of_frames(decoded_frames(5, up=[1, 0, 0]))


def test_the_floor_is_the_median_of_those_seen():
    frames = decoded_frames(3, floor=[0, 0, 0, 0])
    assert view_of_frames(frames)[1] is None
    frames += decoded_frames(3, floor=[0.0, 1.0, 0.0, 0.9]) + decoded_frames(1, floor=[0.0, 0.9, 0.4, 1.8])
    view, floor_m = view_of_frames(frames)
    assert floor_m == pytest.approx(-0.9)
    assert view.R_room_from_camera[1].tolist() == pytest.approx([0, 1, 0])


def test_a_choice_that_cannot_be_had_frees_the_port(port, ports):
    with Sender(port):
        with pytest.raises(InvalidOption, match="body_cekf"):
            opened(port, ports, estimator="rhythmic_ekf")
        opened(port, ports).close()


def test_one_session_at_a_time(port, ports):
    with Sender(port):
        first = opened(port, ports)
        with pytest.raises(PortUnavailable, match="stop that one first"):
            opened(port, ports)
        first.close()
        opened(port, ports).close()


def test_a_port_that_is_taken(port):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", port))
        ports = CapturePorts(CaptureSettings(skeleton_ports=[port]), QUICK)
        ports.open_configured()
        assert ports.offered() == []
        with pytest.raises(PortUnavailable, match="choose another port"):
            opened(port, ports)
        ports.close()
    nowhere = CapturePorts(CaptureSettings(skeleton_host="192.0.2.7", skeleton_ports=[]), QUICK)
    with pytest.raises(PortUnavailable, match="AMBULA_SKELETON_HOST"):
        opened(port, nowhere)


def test_a_port_of_a_session_closes_with_it(port):
    ports = CapturePorts(CaptureSettings(skeleton_ports=[]), QUICK)
    with Sender(port):
        opened(port, ports).close()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as again:
        again.bind(("127.0.0.1", port))


def test_what_is_offered(port, ports):
    ports.open_configured()
    (offered,) = ports.offered()
    assert offered.spec == f"device:kinect?port={port}"
    assert not offered.is_sending
    assert "nothing arrives" in offered.title
    with Sender(port):
        wait_until(lambda: ports.offered()[0].is_sending)
        assert ports.offered()[0].title == f"Kinect on port {port}"
    wait_until(lambda: not ports.offered()[0].is_sending)


def test_an_unconfigured_port_is_offered_while_it_is_sent_to(port, monkeypatch):
    monkeypatch.delenv("AMBULA_SKELETON_PORTS", raising=False)
    settings = CaptureSettings()
    ports = CapturePorts(settings, QUICK)
    ports.use(port)
    assert ports.offered() == []
    with Sender(port):
        wait_until(ports.offered)
    wait_until(lambda: ports.offered() == [])
    ports.close()


def test_garbage_between_frames_is_counted_and_changes_nothing(port, ports):
    garbage = [b"", b"\x00\xff", b"[" * 60_000, datagram(0)[:-3], json.dumps({"camera": "kinect_v2"}).encode()]
    with Sender(port) as sender:
        source = opened(port, ports)
        for _ in range(20):
            for each in garbage:
                sender.send(each)
            time.sleep(0.005)
        reached = source.counts()[0].received
        wait_until(lambda: source.counts()[0].received > reached + 10)
        wait_until(lambda: refused_at(ports).get(Reason.WRONG_SHAPE) == 20)
        assert refused_at(ports) == {Reason.UNDECODABLE: 80, Reason.WRONG_SHAPE: 20}
        count = source.counts()[0]
        assert (count.lost, count.duplicated) == (0, 0)
        assert source.rejections() == []
        source.close()


def test_only_those_who_may_send_are_heard(port):
    stranger = CapturePorts(CaptureSettings(skeleton_ports=[], skeleton_senders=["10.0.0.0/8"]), QUICK)
    with Sender(port), pytest.raises(NothingArrives, match="may not send"):
        opened(port, stranger)
    known = CapturePorts(CaptureSettings(skeleton_ports=[], skeleton_senders=["127.0.0.1"]), QUICK)
    with Sender(port):
        opened(port, known).close()


def test_one_computer_at_a_time_and_the_next_one_takes_over(port, ports):
    ports.open_configured()
    with Sender(port):
        source = opened(port, ports)
        with Sender(port, first=500, bodies=[]):
            wait_until(lambda: refused_at(ports).get(Reason.UNKNOWN_SENDER, 0) >= 10)
    taken(source)
    reached = source.counts()[0].received
    with Sender(port, first=0):
        wait_until(lambda: source.counts()[0].received > reached + 10)
    assert {message.payload.people[0] for message in taken(source)} == {1}
    assert source.counts()[0].lost == 0
    assert {each.reason for each in source.rejections()} <= {Reason.CLOCK_BACKWARDS}
    source.close()


def test_a_loop_that_does_not_fetch_loses_the_newest(port):
    few = dataclasses.replace(QUICK, most_waiting=5)
    ports = CapturePorts(CaptureSettings(skeleton_ports=[]), few)
    with Sender(port):
        source = opened(port, ports)
        wait_until(lambda: source.counts()[0].received >= 15)
    messages = taken(source)
    assert len(messages) == 5
    dropped = {each.reason: each.count for each in source.rejections()}
    assert dropped[Reason.QUEUE_FULL] == source.counts()[0].received - 5
    source.close()


def test_the_sender_of_the_readme_is_understood(port, ports, tmp_path):
    """Literally as printed there."""
    text = README.read_text()
    code = text.split("```python\n")[1].split("```")[0]
    assert "json.dumps(frame)" in code
    assert len([line for line in code.splitlines() if line.strip()]) <= 25
    script = tmp_path / "sender.py"
    script.write_text(code)
    process = subprocess.Popen([sys.executable, "-I", str(script), "127.0.0.1", str(port)])
    patient = CapturePorts(CaptureSettings(skeleton_ports=[]), dataclasses.replace(QUICK, first_frame_s=20.0))
    try:
        source = opened(port, patient)
        wait_until(lambda: source.counts()[0].received >= 45)
        messages = taken(source)
    finally:
        process.terminate()
        process.wait(10)
    description = source.describe()
    assert description.cameras[0].kind is CameraKind.KINECT_V2
    assert description.cameras[0].floor_m == pytest.approx(-0.9)
    last = messages[-1].payload
    assert (last.body, last.people) == ([1], [1])
    knee = last.position[0][description.cameras[0].joints.index("knee_right")]
    assert knee == pytest.approx([-2.5, -0.42, 0.09])
    assert source.rejections() == []
    source.close()
    with pytest.raises(SourceError):
        opened(port, ports)
