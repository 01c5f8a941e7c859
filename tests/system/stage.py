"""The parts that system tests play: a producer, a consumer, an archive, and child processes."""

import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from schemas.checkpoint import Checkpoint
from schemas.health import Progress
from schemas.imu import ImuBatch, SensorSamples
from schemas.session import Anthropometry, SessionDescription
from schemas.signals import IMU, checkpoint_key, description_key, progress_key, session_token_key
from services.bus.connection import Bus
from services.bus.loop import EventLoop
from services.bus.publisher import StreamPublisher
from services.bus.received import Received
from services.bus.receiver import Delivery, StreamReceiver
from services.bus.settings import BusSettings
from services.flow.message import Stream
from services.flow.position import Position

HUB = Stream(IMU, "hub")
TICK_NS = 10_000_000


def wait_until(condition: Callable[[], Any], timeout_s: float = 10.0) -> None:
    """Poll until the condition holds; fails the test when it does not in time."""
    end = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > end:
            pytest.fail(f"not within {timeout_s} s")
        time.sleep(0.01)


def describe(session: str) -> SessionDescription:
    """The least a session can be."""
    body = Anthropometry(
        height_m=None, mass_kg=None, thigh_length_m=0.4, shank_length_m=0.4, hip_width_m=0.2, source="default"
    )
    return SessionDescription(
        session=session, title="", started_unix_ns=0, origin="synthetic", protocol="", estimator="ekf",
        walk_path="turning", hubs=[], anthropometry=body, standing=[], reference=[], duration_s=None,
    )  # fmt: skip


def sample(number: int) -> ImuBatch:
    """One hub message whose sample time is its number."""
    zero = [0.0, 0.0, 0.0]
    samples = SensorSamples(captured_ns=[number], angular_velocity=[zero], specific_force=[zero])
    return ImuBatch(sensors=[samples], marks=[])


class FakeIngest:
    """A producer as ingest is one: token, description and one hub's stream."""

    def __init__(self, settings: BusSettings, session: str) -> None:
        self.bus = Bus.open(settings, "ingest")
        self.session = session
        self.publisher = StreamPublisher(self.bus, session, HUB)
        answer = Received(description_key(settings.site, session), b"", describe(session).model_dump_json().encode())
        self.bus.serve(answer.key, lambda *_: [answer])
        self.token = self.bus.declare_token(session_token_key(settings.site, session))
        self.sent = 0

    def send(self, count: int, rate_hz: float | None = None) -> None:
        """Send the next `count` messages, paced or at once."""
        for _ in range(count):
            self.publisher.send(self.sent * TICK_NS, sample(self.sent))
            self.sent += 1
            if rate_hz is not None:
                time.sleep(1.0 / rate_hz)

    def end(self) -> None:
        """Send the final message."""
        self.publisher.end(self.sent * TICK_NS)
        self.sent += 1

    def close(self) -> None:
        """Leave as a process that was killed would: everything at once."""
        self.bus.close()


class Collector:
    """A consumer with its own loop on its own thread; keeps what was delivered."""

    def __init__(self, settings: BusSettings, service: str = "gateway") -> None:
        self.bus = Bus.open(settings, service)
        self.loop = EventLoop(self.bus)
        self.deliveries: list[Delivery] = []
        self._thread = threading.Thread(target=self.loop.run, daemon=True)
        self._thread.start()

    def receive(self, session: str, stream: Stream, position: Position | None = None) -> StreamReceiver:
        """Collect a stream."""
        made: list[StreamReceiver] = []
        self.loop.post(lambda: made.append(self.loop.receive(session, stream, position, self.deliveries.append)))
        wait_until(lambda: made)
        return made[0]

    def numbers(self, stream: Stream | None = None) -> list[int]:
        """Sequence numbers in the order of delivery."""
        return [d.envelope.sequence for d in list(self.deliveries) if stream is None or d.stream == stream]

    def ended(self) -> bool:
        """A final message was delivered."""
        return bool(self.deliveries) and self.deliveries[-1].envelope.final

    def close(self) -> None:
        """Stop the loop and leave the bus."""
        self.loop.stop()
        self._thread.join(5.0)
        self.loop.close()
        self.bus.close()


class Keeper:
    """Plays the archive towards node services: keeps checkpoints in memory, says that everything is durable."""

    def __init__(self, settings: BusSettings) -> None:
        self.bus = Bus.open(settings, "archive")
        self.kept: dict[str, bytes] = {}
        self.history: list[Checkpoint] = []
        self.answers = True
        key = checkpoint_key(settings.site, "*", "*")
        self.bus.subscribe(key, self._keep)
        self.bus.serve(key, self._answer)

    def tell_progress(self, session: str, positions: Mapping[str, int], *, ended: bool = False) -> None:
        """Say how far the archive is; `ended`: it has the whole session."""
        progress = Progress(service="archive", captured_ns=0, positions=dict(positions), ended=ended)
        self.bus.put(progress_key(self.bus.settings.site, session, "archive"), progress.model_dump_json().encode())

    def close(self) -> None:
        """Leave."""
        self.bus.close()

    def _keep(self, received: Received) -> None:
        self.kept[received.key] = received.payload
        self.history.append(Checkpoint.model_validate_json(received.payload))

    def _answer(self, key: str, _parameters: dict[str, str], _body: bytes) -> list[Received]:
        return [Received(key, b"", self.kept[key])] if self.answers and key in self.kept else []


class Processes:
    """Child processes of one test; none survives it."""

    def __init__(self, settings: BusSettings, folder: Path) -> None:
        self._environment = {**os.environ, "AMBULA_ROUTER": settings.router, "AMBULA_SITE": settings.site}
        self._folder = folder
        self._children: list[subprocess.Popen[bytes]] = []

    def start(self, *command: str) -> subprocess.Popen[bytes]:
        """`python command...`; its standard error goes to `log`."""
        with self.log_file.open("ab") as log:
            child = subprocess.Popen([sys.executable, *command], env=self._environment, stdout=log, stderr=log)
        self._children.append(child)
        return child

    @property
    def log_file(self) -> Path:
        """What all children said."""
        return self._folder / "children.log"

    def log(self) -> str:
        """What all children said so far."""
        return self.log_file.read_text()

    def close(self) -> None:
        """Kill what still runs."""
        for child in self._children:
            child.kill()
            child.wait()
