import errno
import threading
import time
from functools import partial

import pytest

from schemas.archive_layout import RecordingState
from services.archive.catalogue import Catalogue
from services.archive.disk import Disk
from services.archive.manifest import new_manifest
from services.archive.parameters import ArchiveParameters
from services.archive.recorder import Recorder
from services.archive.recovery import recover
from services.archive.sealer import Sealer, SealJob
from services.archive.writer import SessionWriter
from services.recordings.folder import read_manifest
from services.recordings.reader import open_recording

VERSION = "0.1.0"
FAST = ArchiveParameters(flush_interval_s=0.01, retry_s=0.02)


class Stage:
    """A recorder with everything that it reports."""

    def __init__(self, folder, description, parameters=FAST):
        self.folder = folder
        self.description = description
        self.parameters = parameters
        self.closed = []
        self.event = threading.Event()
        self.recorder = Recorder(parameters, self._on_closed)

    def _on_closed(self, closed):
        self.closed.append(closed)
        self.event.set()

    def begin(self, session, disk=None):
        folder = self.folder / session
        folder.mkdir()
        description = self.description.model_copy(update={"session": session})
        writer = SessionWriter(folder, description, VERSION, disk=disk or Disk(), parameters=self.parameters)
        self.recorder.begin(writer)
        return writer


@pytest.fixture
def stage(tmp_path, description):
    stage = Stage(tmp_path, description)
    yield stage
    stage.recorder.stop()


def until(condition, timeout_s=5.0):
    deadline = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < deadline, "it never came"
        time.sleep(0.002)


def test_messages_become_durable_and_the_files_are_closed_on_request(stage, tape):
    writer = stage.begin("s1")
    for record in tape.walk(50):
        assert stage.recorder.put("s1", record)
    until(lambda: writer.durable.positions == {"imu/hub": 49})
    stage.recorder.finish("s1")
    until(lambda: stage.closed)
    assert (stage.closed[0].error, stage.closed[0].last) == (None, True)
    assert [path.name for path in stage.closed[0].parts] == ["raw.mcap.part"]
    stage.recorder.put("s1", tape.record(tape.hub, 50))
    until(lambda: stage.recorder.dropped == 1)


def test_one_session_whose_disk_fails_leaves_the_others_alone(stage, tape, failing_disk):
    stage.begin("bad", failing_disk(6, errno.ENOSPC, forever=True))
    good = stage.begin("good")
    for record in tape.walk(200):
        stage.recorder.put("bad", record)
        stage.recorder.put("good", record)
        time.sleep(0.0005)
    until(lambda: good.durable.positions == {"imu/hub": 199})
    until(lambda: stage.closed)
    assert stage.closed[0].session == "bad"
    assert stage.closed[0].error.errno == errno.ENOSPC
    assert stage.recorder.alive


class SlowDisk(Disk):
    """Syncs take long; writes do not."""

    def __init__(self, gate):
        self.gate = gate

    def sync(self, descriptor):
        self.gate.wait(10)
        super().sync(descriptor)


def test_a_slow_sync_does_not_hold_up_what_a_kill_would_cost(stage, tape):
    """The data reach the operating system while the sync still waits; they only become durable after it."""
    gate = threading.Event()
    writer = stage.begin("s1", SlowDisk(gate))
    for record in tape.walk(30):
        stage.recorder.put("s1", record)
        time.sleep(0.002)
    until(lambda: len(list(open_recording(stage.folder / "s1").records())) == 30)
    assert writer.durable.positions == {}
    gate.set()
    until(lambda: writer.durable.positions == {"imu/hub": 29})


class UnsyncableDisk(Disk):
    def sync(self, descriptor):
        raise OSError(errno.EIO, "injected")


def test_a_failed_sync_ends_the_file_and_promises_nothing(stage, tape):
    """What a failed sync has left on the disk is unknown: nothing more may go into that file."""
    writer = stage.begin("s1", UnsyncableDisk())
    stage.recorder.put("s1", tape.record(tape.hub, 0))
    until(lambda: stage.closed)
    assert (stage.closed[0].error.errno, stage.closed[0].last) == (errno.EIO, True)
    assert writer.durable.positions == {}
    stage.recorder.put("s1", tape.record(tape.hub, 1))
    until(lambda: stage.recorder.dropped == 1)


def test_files_rotate_while_messages_come(tmp_path, description, tape):
    stage = Stage(tmp_path, description, ArchiveParameters(flush_interval_s=0.01, rotation_s=0.05))
    writer = stage.begin("s1")
    for record in tape.walk(100):
        stage.recorder.put("s1", record)
        time.sleep(0.002)
    until(lambda: writer.durable.positions == {"imu/hub": 99})
    stage.recorder.stop()
    assert [closed.last for closed in stage.closed] == [False] * (len(stage.closed) - 1) + [True]
    assert len([part for closed in stage.closed for part in closed.parts]) > 1
    assert list(open_recording(tmp_path / "s1").records()) == tape.walk(100)


class StuckDisk(Disk):
    def __init__(self, gate):
        self.gate = gate

    def write(self, descriptor, data):
        self.gate.wait(10)
        super().write(descriptor, data)


def test_a_stuck_disk_fills_the_queue_and_blocks_nobody_for_long(tmp_path, description, tape):
    gate = threading.Event()
    stage = Stage(tmp_path, description, ArchiveParameters(flush_interval_s=0.01, queue_records=20))
    writer = stage.begin("s1", StuckDisk(gate))
    records = tape.walk(200)
    put = 0
    while stage.recorder.put("s1", records[put]):
        put += 1
    assert stage.recorder.waiting == 20
    gate.set()
    for record in records[put:]:
        until(partial(stage.recorder.put, "s1", record))
    until(lambda: writer.durable.positions == {"imu/hub": 199})
    stage.recorder.stop()
    assert writer.counts.lost == 0


def test_stopping_writes_what_was_put(stage, tape):
    stage.begin("s1")
    for record in tape.walk(500):
        stage.recorder.put("s1", record)
    stage.recorder.stop()
    assert len(list(open_recording(stage.folder / "s1").records())) == 500


def test_sealer_closes_files_and_tells_the_catalogue(recorded, tape, description, tmp_path):
    folder = recorded(tape.walk(30), closed=False)
    sealer = Sealer("ambula test", Disk(), FAST)
    begin = new_manifest(description, VERSION)
    catalogue = Catalogue(tmp_path)
    sealer.submit(SealJob(folder, begin))
    assert sealer.wait(5)
    assert [item.state for item in catalogue.sessions()] == [RecordingState.RECORDING]
    sealer.submit(SealJob(folder, begin, [folder / "raw.mcap.part"], RecordingState.FINISHED))
    assert sealer.wait(5)
    sealer.stop()
    (item,) = catalogue.sessions()
    assert item.state is RecordingState.FINISHED
    assert b'"raw.mcap"' in catalogue.as_json()
    (folder / "manifest.json").write_text("{")
    assert catalogue.sessions() == []


@pytest.mark.parametrize("fail_at", range(1, 14))
def test_sealer_tries_again(recorded, tape, description, failing_disk, fail_at):
    folder = recorded(tape.walk(30), closed=False)
    disk = failing_disk(fail_at)
    sealer = Sealer("ambula test", disk, FAST)
    job = SealJob(folder, new_manifest(description, VERSION), [folder / "raw.mcap.part"], RecordingState.FINISHED)
    sealer.submit(job)
    assert sealer.wait(5)
    sealer.stop()
    assert read_manifest(folder).state is RecordingState.FINISHED
    assert len(list(open_recording(folder).records())) == 30
    assert recover(folder, None, VERSION, Disk()).parts == []
    assert [entry.name for entry in read_manifest(folder).files] == ["raw.mcap"]


def test_files_that_wait_to_be_closed_can_be_taken_back(recorded, tape, description, failing_disk):
    """A session that goes on takes stock of its own open files; nobody may close them meanwhile."""
    folder = recorded(tape.walk(30), closed=False)
    sealer = Sealer("ambula test", failing_disk(1, errno.ENOSPC, forever=True), FAST)
    sealer.submit(SealJob(folder, new_manifest(description, VERSION), [folder / "raw.mcap.part"]))
    until(lambda: sealer.failures > 1)
    sealer.take_back(folder)
    assert sealer.wait(1)
    failures = sealer.failures
    sealer.take_back(folder)
    sealer.stop()
    assert sealer.failures == failures
    assert recover(folder, None, VERSION, Disk()).parts == [folder / "raw.mcap.part"]
