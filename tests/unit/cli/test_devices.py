"""Commands around a live camera: sending one, and ending a session properly."""

import os
import signal
import socket
import threading
import time

import pytest
from rich.console import Console
from typer.testing import CliRunner

from schemas.vocabulary import CameraKind
from services.cli.__main__ import app
from services.cli.doctor import machine
from services.cli.interrupt import on_interrupt
from services.cli.send_skeletons import send
from services.ingest.capture.datagram import decode_frame
from tests.unit.ingest.capture.test_sender import recorded

QUIET = Console(quiet=True)


class TenFrames:
    """A source with a camera at 50 Hz."""

    def __init__(self, description):
        self.description = description
        self.camera, messages = recorded(CameraKind.KINECT_V2)
        self.frames = [
            message._replace(payload=message.payload.model_copy(update={"captured_ns": [k * 20_000_000]}))
            for k, message in enumerate([*messages, *messages])
        ]

    def describe(self):
        return self.description.model_copy(update={"cameras": [self.camera]})

    def messages(self):
        return iter(self.frames)


@pytest.fixture
def listening():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as bound:
        bound.bind(("127.0.0.1", 0))
        bound.settimeout(5.0)
        yield bound


def test_frames_are_sent_when_they_are_due(listening, monkeypatch):
    from services.ingest.source import open_source

    source = TenFrames(open_source("synthetic:walk?duration=6").describe())
    monkeypatch.setattr("services.ingest.source.open_source", lambda _spec: source)
    arrivals = []

    def receive():
        for _ in range(10):
            arrivals.append((time.monotonic(), decode_frame(listening.recv(65_536))))

    receiving = threading.Thread(target=receive)
    receiving.start()
    frames, seconds = send("any", "127.0.0.1", listening.getsockname()[1], QUIET)
    receiving.join(10.0)
    assert (frames, seconds) == (10, pytest.approx(0.18))
    assert [frame.seq for _, frame in arrivals] == list(range(10))
    assert arrivals[-1][0] - arrivals[0][0] == pytest.approx(0.5, abs=0.4)


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["synthetic:walk?duration=6"], "no camera"),
        (["nothing-of-that-name"], "no known recording"),
        (["synthetic:walk", "--port", "0"], "port"),
        (["synthetic:walk", "--port", "99999"], "port"),
    ],
)
def test_what_cannot_be_sent_is_said(arguments, word):
    result = CliRunner().invoke(app, ["send-skeletons", *arguments])
    assert result.exit_code != 0
    assert word in " ".join(result.output.split())


def interrupted(action, between):
    """Ctrl-C, and once more after `between` held."""
    with on_interrupt(action):
        for _ in range(2):
            os.kill(os.getpid(), signal.SIGINT)
            assert between()
        time.sleep(5.0)


def test_the_first_interrupt_finishes_and_the_second_one_breaks_off():
    done = threading.Event()
    with pytest.raises(KeyboardInterrupt):
        interrupted(done.set, lambda: done.wait(5.0))
    assert done.is_set()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_without_an_action_an_interrupt_is_what_it_was():
    with pytest.raises(KeyboardInterrupt):
        interrupted(None, lambda: pytest.fail("it went on"))


def test_another_thread_may_run_it():
    ran = []

    def work():
        with on_interrupt(ran.clear):
            ran.append(1)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert ran == [1]


@pytest.mark.parametrize(
    ("environment", "ok", "word"),
    [
        ({}, True, "127.0.0.1, port 7788"),
        ({"HOST": "0.0.0.0"}, None, "any computer"),
        ({"HOST": "0.0.0.0", "SENDERS": '["10.0.0.4"]'}, True, "0.0.0.0"),
        ({"PORTS": "[0]"}, False, "AMBULA_SKELETON"),
    ],
)
def test_doctor_says_who_is_heard(monkeypatch, environment, ok, word):
    for name in ("HOST", "PORTS", "SENDERS"):
        monkeypatch.delenv(f"AMBULA_SKELETON_{name}", raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(f"AMBULA_SKELETON_{name}", value)
    (finding,) = [each for each in machine.findings() if each.subject == "Cameras"]
    assert finding.ok is ok
    assert word in finding.says
