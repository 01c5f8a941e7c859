"""A whole site of real processes with synthetic patients who walk, and what the gateway costs while they do."""

import os
import socket
import statistics
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from schemas.signals import IMU, stream_key
from services.bus.connection import Bus
from services.bus.received import Received
from services.bus.settings import BusSettings
from services.cli.door import Door
from services.cli.supervisor import Supervisor
from services.flow.message import Envelope

SERVICES = ["archive", "estimation", "segmentation", "metrics", "gateway", "ingest"]
WALK = "synthetic:walk?speed={speed:.2f}&seed={seed}&duration=900&truth=0"
READY_S = 300.0
SESSION_WORD = 2


@dataclass
class Origins:
    """When each session's time zero was on this machine's monotonic clock.

    The sensors are synthetic: a sample is captured when its time has come. The earliest of all arrivals at a listener
    on the bus is nearest to that, so it is the origin; it is late by one hop over the bus, some tenths of a ms.
    """

    s: dict[str, float] = field(default_factory=dict)

    def take(self, received: Received) -> None:
        """One message of sensors."""
        if received.payload:
            zero_s = time.monotonic() - Envelope.decode(received.attachment).captured_ns * 1e-9
            session = received.key.split("/")[SESSION_WORD]
            self.s[session] = min(zero_s, self.s.get(session, zero_s))


@dataclass(frozen=True)
class Site:
    """Where it is, who runs, and the gateway's process."""

    door: Door
    sessions: list[str]
    origins: Origins
    gateway_pid: int


@contextmanager
def open_site(patients: int) -> Iterator[Site]:
    """Start everything, then a walk for each patient."""
    with tempfile.TemporaryDirectory(prefix="ambula-web-") as data:
        port = _free_port()
        environment = {"AMBULA_HTTP_PORT": str(port), "AMBULA_DATA_DIR": data, "AMBULA_DATABASE": ""}
        settings = BusSettings(router=f"tcp/127.0.0.1:{_free_port()}")
        with Supervisor(SERVICES, settings, environment=environment, output=lambda _: None) as stack:
            stack.wait_until_ready(timeout_s=READY_S)
            door = Door.of_first_administrator(f"http://127.0.0.1:{port}", Path(data))
            origins = Origins()
            with Bus.open(stack.settings, "bench") as bus:
                bus.subscribe(stream_key(settings.site, "*", IMU, "*"), origins.take)
                sessions = [_begin(door, number) for number in range(patients)]
                _wait_until_live(door, origins, patients)
                yield Site(door, sessions, origins, stack.pid("gateway"))


def _begin(door: Door, number: int) -> str:
    source = WALK.format(speed=0.8 + 0.03 * number, seed=number + 1)
    patient = door.ask("patients", {})["code"]
    return str(door.ask("sessions", {"source": source, "speed": 1.0, "patient": patient})["id"])


def _wait_until_live(door: Door, origins: Origins, patients: int) -> None:
    end_s = time.monotonic() + READY_S
    while len(origins.s) < patients or int(door.ask("sessions?state=live&limit=1")["total"]) < patients:
        if time.monotonic() > end_s:
            raise TimeoutError(f"not all of {patients} sessions run")
        time.sleep(0.2)


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


class Cost:
    """Processor time and memory of a process, sampled once a second from /proc."""

    def __init__(self, pid: int) -> None:
        self._pid = pid
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self.cores: list[float] = []
        self.rss_mb: list[float] = []

    def __enter__(self) -> "Cost":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stopping.set()
        self._thread.join()

    @property
    def growth_mb(self) -> float:
        """MB between the first and the last fifth."""
        fifth = max(1, len(self.rss_mb) // 5)
        return statistics.median(self.rss_mb[-fifth:]) - statistics.median(self.rss_mb[:fifth])

    def _watch(self) -> None:
        ticks, page_bytes = os.sysconf("SC_CLK_TCK"), os.sysconf("SC_PAGE_SIZE")
        before_s, used_s = time.monotonic(), self._used_s(ticks)
        while not self._stopping.wait(1.0):
            now_s, now_used_s = time.monotonic(), self._used_s(ticks)
            self.cores.append((now_used_s - used_s) / (now_s - before_s))
            self.rss_mb.append(int(Path(f"/proc/{self._pid}/statm").read_text().split()[1]) * page_bytes / 1e6)
            before_s, used_s = now_s, now_used_s

    def _used_s(self, ticks: int) -> float:
        words = Path(f"/proc/{self._pid}/stat").read_text().rpartition(")")[2].split()
        return (int(words[11]) + int(words[12])) / ticks
