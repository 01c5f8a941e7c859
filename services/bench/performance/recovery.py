"""Scoreboard of the archive: what a kill costs, what is missing after the restart, what a flush costs.

A hub publishes at 100 Hz over a real bus; the archive, a process of its own, is killed at random times after it has
caught up, and started again. Loss is counted in the files as the kill left them, against what had been sent.
"""

import os
import random
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from schemas.conditions import UNSAID
from schemas.health import Progress
from schemas.imu import ImuBatch, SensorSamples
from schemas.session import Anthropometry, HubDescription, SessionDescription
from schemas.signals import IMU, JOINT_STATE, description_key, progress_key, session_token_key
from schemas.vocabulary import Task
from services.archive.writer import SessionWriter
from services.bench.scoreboard import Row, Scoreboard, at_most, informative
from services.bus.connection import Bus
from services.bus.publisher import StreamPublisher
from services.bus.received import Received
from services.bus.router import choose_endpoint, open_router
from services.bus.settings import BusSettings
from services.flow.message import Envelope, Stream
from services.recordings.reader import open_recording
from services.recordings.record import Record

KILLS = 20
RATE_HZ = 100.0
SENSORS = 5
HUB = Stream(IMU, "hub")
JOINTS = Stream(JOINT_STATE, "estimation")
CAUGHT_UP = 50
"""Messages behind, of which the flush and the report every 100 ms explain 30."""
LOSS_TARGET_S = 0.15
WAIT_S = 30.0
FLUSHES = 100
FLUSH_TICKS = 10
"""Ticks between two flushes."""
PATIENTS = 100


def run(json_path: Path | None = None, kills: int = KILLS) -> Scoreboard:
    """Kill and restart the archive `kills` times, then time its writer. About two seconds a kill."""
    rows = [*_kill_rows(kills), *_flush_rows()]
    scoreboard = Scoreboard("recovery", rows)
    if json_path is not None:
        scoreboard.write_json(json_path)
    return scoreboard


def _kill_rows(kills: int) -> Iterator[Row]:
    settings = BusSettings(router=choose_endpoint("tcp/127.0.0.1:0"), site="bench")
    with tempfile.TemporaryDirectory() as name, open_router(settings), Bus.open(settings, "bench") as bus:
        data_dir = Path(name)
        hub = _Hub(bus, describe("bench"))
        losses, resumed = [], []
        chance = random.Random(1)
        for _ in range(kills):
            with _archive(settings, data_dir) as process:
                begun = time.monotonic()
                _until(lambda: hub.has_caught_up)
                resumed.append(time.monotonic() - begun)
                time.sleep(chance.uniform(0.2, 1.2))
                process.kill()
                sent = hub.sent
                process.wait()
                hub.forget_progress()
            losses.append((sent - 1 - _held(data_dir)) / RATE_HZ)
        with _archive(settings, data_dir):
            hub.stop()
            _until(lambda: hub.durable == hub.sent - 1)
        missing = hub.sent - len({record.envelope.sequence for record in _records(data_dir)})
    yield at_most(f"worst loss of {kills} kills, before the restart", max(losses), "s", LOSS_TARGET_S)
    yield informative("mean loss, before the restart", statistics.mean(losses), "s")
    yield at_most("missing after restart and replay", missing / RATE_HZ, "s", 0.0)
    yield informative("start of the process until it has caught up, median", statistics.median(resumed), "s")
    yield informative("start of the process until it has caught up, worst", max(resumed), "s")


def _flush_rows() -> Iterator[Row]:
    """One patient tick by tick, then a floor of them at five ticks a message: 100 ms of two streams at 100 Hz."""
    with tempfile.TemporaryDirectory() as name:
        pushes, syncs, size = _time_flushes(Path(name), 1, ticks=1, flushes=FLUSHES)
    yield informative("processor time to write 100 ms, one patient, median", statistics.median(pushes) * 1e3, "ms")
    yield informative("sync after it, median", statistics.median(syncs) * 1e3, "ms")
    yield informative("sync after it, worst", max(syncs) * 1e3, "ms")
    yield informative("file size per message, while open", size, "bytes")
    with tempfile.TemporaryDirectory() as name:
        pushes, syncs, _ = _time_flushes(Path(name), PATIENTS, ticks=5, flushes=10)
    yield informative(f"processor time to begin the files of {PATIENTS} patients", pushes[0] * 1e3, "ms")
    written, synced = statistics.median(pushes[1:]) * 1e3, statistics.median(syncs) * 1e3
    yield at_most(f"processor time to write 100 ms, {PATIENTS} patients, median", written, "ms", 100.0)
    yield informative(f"syncs one after the other, {PATIENTS} patients, median", synced, "ms")


def _time_flushes(folder: Path, patients: int, ticks: int, flushes: int) -> tuple[list[float], list[float], float]:
    """Processor seconds to write and push, seconds to sync, each for all patients together; bytes per message."""
    writers = []
    for number in range(patients):
        (folder / f"p{number}").mkdir()
        writers.append(SessionWriter(folder / f"p{number}", describe(f"p{number}"), "bench"))
    pushes, syncs = [], []
    payloads = [b"".join(sample(number + tick) for tick in range(ticks)) for number in range(50)]
    each = FLUSH_TICKS // ticks
    for place in range(flushes):
        begun = time.process_time()
        for writer in writers:
            for number in range(place * each, place * each + each):
                envelope = Envelope(0, number, int(number * ticks * 1e9 / RATE_HZ))
                for stream in (HUB, JOINTS):
                    writer.write(Record(stream, envelope, payloads[number % 50], 0))
            writer.push()
        pushes.append(time.process_time() - begun)
        begun = time.perf_counter()
        for writer in writers:
            writer.flush()
        syncs.append(time.perf_counter() - begun)
    size = sum(part.stat().st_size for writer in writers for part in writer.close())
    return pushes, syncs, size / (patients * flushes * each * 2)


class _Hub:
    """A producer as ingest is one, on a thread of its own."""

    def __init__(self, bus: Bus, description: SessionDescription) -> None:
        self.sent = 0
        self.durable = -1
        self._publisher = StreamPublisher(bus, description.session, HUB)
        site, text = bus.settings.site, description.model_dump_json().encode()
        self._declared = [
            bus.serve(description_key(site, description.session), lambda key, *_: [Received(key, b"", text)]),
            bus.subscribe(progress_key(site, description.session, "archive"), self._hear),
            bus.declare_token(session_token_key(site, description.session)),
        ]
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._walk, daemon=True)
        self._thread.start()

    @property
    def has_caught_up(self) -> bool:
        """The archive has promised nearly all that was sent."""
        return self.durable >= 0 and self.sent - self.durable < CAUGHT_UP

    def forget_progress(self) -> None:
        """The archive has been killed: what it said no longer counts."""
        self.durable = -1

    def stop(self) -> None:
        """Send no more."""
        self._stop.set()
        self._thread.join()

    def _walk(self) -> None:
        begun = time.monotonic()
        while not self._stop.wait(max(0.0, begun + self.sent / RATE_HZ - time.monotonic())):
            self._publisher.send_encoded(Envelope(0, self.sent, int(self.sent * 1e9 / RATE_HZ)), sample(self.sent))
            self.sent += 1

    def _hear(self, received: Received) -> None:
        self.durable = Progress.model_validate_json(received.payload).positions.get(HUB.name, -1)


def describe(session: str) -> SessionDescription:
    """A session with one hub and a body of ordinary size."""
    body = Anthropometry(
        height_m=1.75, mass_kg=70.0, thigh_length_m=0.43, shank_length_m=0.43, hip_width_m=0.17, source="default"
    )
    return SessionDescription(
        session=session,
        title="recovery",
        started_unix_ns=time.time_ns(),
        origin="synthetic",
        protocol="walk",
        task=Task.WALK,
        walkway_m=None,
        conditions=UNSAID,
        estimator="ekf",
        walk_path="turning",
        hubs=[HubDescription(name="hub", sensors=[])],
        cameras=[],
        anthropometry=body,
        standing=[],
        reference=[],
        duration_s=None,
        known_rhythms=[],
    )


def sample(number: int) -> bytes:
    """One tick of five IMUs: about 1 kB of digits that do not compress well."""
    chance = random.Random(number)

    def vector() -> list[float]:
        return [chance.gauss(0.0, 3.0) for _ in range(3)]

    sensors = [
        SensorSamples(captured_ns=[int(number * 1e9 / RATE_HZ)], angular_velocity=[vector()], specific_force=[vector()])
        for _ in range(SENSORS)
    ]
    return ImuBatch(sensors=sensors, marks=[]).model_dump_json().encode()


@contextmanager
def _archive(settings: BusSettings, data_dir: Path) -> Iterator[subprocess.Popen[bytes]]:
    environment = {
        **os.environ,
        "AMBULA_ROUTER": settings.router,
        "AMBULA_SITE": settings.site,
        "AMBULA_DATA_DIR": str(data_dir),
    }
    command = [sys.executable, "-m", "services.archive"]
    process = subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL)
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


def _records(data_dir: Path) -> Iterator[Record]:
    return (record for record in open_recording(data_dir / "bench").records() if record.stream == HUB)


def _held(data_dir: Path) -> int:
    """Last sequence number in the files."""
    return open_recording(data_dir / "bench").ledger.positions()[HUB.name].sequence


def _until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + WAIT_S
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError(f"the archive did not catch up within {WAIT_S} s; see its log")
        time.sleep(0.005)
