"""What the service looks at besides messages: free space, folders of an earlier run, the expected streams."""

import shutil

import pytest

from schemas.archive_layout import RecordingState
from schemas.checkpoint import StreamPosition
from schemas.health import Reason
from schemas.session import ReferenceChannel
from services.archive.disk import Disk
from services.archive.live_session import LiveSession, Phase, expected_streams
from services.archive.lock import DataFolderLock, DataFolderUnusable
from services.archive.manifest import store, with_state
from services.archive.parameters import GIB, ArchiveParameters
from services.archive.sealer import do_job
from services.archive.space import Space
from services.archive.stale import StaleFolders
from services.archive.writer import SessionWriter, durable_of
from services.recordings.folder import read_manifest
from services.recordings.ledger import Ledger


class MeasuredDisk(Disk):
    free = 100 * GIB

    def free_bytes(self, folder):
        return self.free


@pytest.mark.parametrize(
    ("free_gib", "low", "stopped"),
    [
        (100, False, False),
        (4.9, True, False),
        (0.9, True, True),
        (1.2, True, True),
        (1.6, True, False),
        (9, False, False),
    ],
)
def test_space_warns_then_stops_and_comes_back_with_room_to_spare(tmp_path, free_gib, low, stopped):
    disk = MeasuredDisk()
    space = Space(tmp_path, disk, ArchiveParameters())
    if free_gib == 1.2:
        disk.free = 0.5 * GIB
        space.look()
    disk.free = free_gib * GIB
    space.look()
    assert (space.low, space.stopped) == (low, stopped)
    assert f"{free_gib:.1f} GiB" in space.advice


def test_a_data_folder_has_one_archive(tmp_path):
    with DataFolderLock(tmp_path / "data"), pytest.raises(DataFolderUnusable, match="AMBULA_DATA_DIR"):
        DataFolderLock(tmp_path / "data")
    with DataFolderLock(tmp_path / "data"):
        pass
    (tmp_path / "file").touch()
    with pytest.raises(DataFolderUnusable, match="AMBULA_DATA_DIR"):
        DataFolderLock(tmp_path / "file")


def test_real_disks_tell_their_free_space(tmp_path):
    assert Disk().free_bytes(tmp_path) == pytest.approx(shutil.disk_usage(tmp_path).free, rel=0.1)


def test_every_archived_stream_of_a_session_is_expected(description):
    computed = {
        "calibration/estimation",
        "data_quality/estimation",
        "joint_state/estimation",
        "rhythm/estimation",
        "learned_rhythm/estimation",
        "segment_motion/estimation",
        "joint_centres/estimation",
        "gait_event/segmentation",
        "stride/segmentation",
        "task_phase/segmentation",
        "repetition/segmentation",
        "metrics/metrics",
    }
    assert {stream.name for stream in expected_streams(description)} == {"imu/hub", *computed}
    with_truth = description.model_copy(update={"reference": [ReferenceChannel(name="knee", unit="rad")]})
    assert {stream.name for stream in expected_streams(with_truth)} >= {"reference/reference"}


def test_progress_is_told_when_it_changes_and_each_second(tmp_path, description, tape):
    live = LiveSession(description, tmp_path, (tape.hub,))
    live.writer = SessionWriter(tmp_path, description, "1")
    live.refresh()
    assert live.progress_due(0.0, 1.0).positions == {}
    assert live.progress_due(0.5, 1.0) is None
    live.writer.write(tape.record(tape.hub, 0))
    live.writer.flush()
    live.refresh()
    assert live.progress_due(0.6, 1.0).positions == {"imu/hub": 0}
    assert live.progress_due(0.7, 1.0) is None
    assert live.progress_due(1.7, 1.0).positions == {"imu/hub": 0}
    assert live.missing_ends == ["imu/hub"]
    live.phase = Phase.WAITING
    assert [item.reason for item in live.health().rejections] == [Reason.NOT_RECORDED]
    live.writer.close()


def test_folders_of_an_earlier_run_are_closed_unless_their_session_is_back(recorded, tape, description, tmp_path):
    for name in ("over", "back"):
        recorded(tape.walk(10), folder=tmp_path / name, closed=False)
    done = recorded(tape.walk(10), folder=tmp_path / "done")
    store(done, with_state(read_manifest(done), RecordingState.FINISHED), Disk())
    (tmp_path / "unreadable").mkdir()
    (tmp_path / "unreadable" / "raw.mcap").write_bytes(b"junk")
    stale = StaleFolders(tmp_path, "0.1.0", Disk())
    assert [folder.name for folder in stale.unclaimed({"back"})] == ["over", "unreadable"]
    assert stale.job(tmp_path / "unreadable") is None
    assert (tmp_path / "unreadable" / "raw.mcap").read_bytes() == b"junk"
    job = stale.job(tmp_path / "over")
    do_job(job, "ambula test", Disk(), 1 << 20)
    assert read_manifest(tmp_path / "over").state is RecordingState.INTERRUPTED
    assert [entry.name for entry in read_manifest(tmp_path / "over").files] == ["raw.mcap"]


def test_ledger_counts_epochs_apart():
    ledger = Ledger()
    assert ledger.expected("a/b", 0) is None
    for sequence in range(3):
        ledger.count("a/b", 0, sequence, sequence * 10, final=False)
    ledger.advance("a/b", 2, 0, 4)
    ledger.count("a/b", 2, 5, 7, final=True)
    assert [ledger.expected("a/b", epoch) for epoch in (0, 2, 3)] == [-1, 6, None]
    assert ledger.positions() == {"a/b": StreamPosition(epoch=2, sequence=5, ended=True)}
    assert [(span.epoch, span.first_sequence, span.last_sequence, span.count) for span in ledger.spans()] == [
        (0, 0, 2, 3),
        (2, 0, 5, 1),
    ]
    assert durable_of(ledger).ended == {"a/b"}
    again = Ledger()
    again.absorb(ledger.spans())
    again.absorb(ledger.spans())
    assert again.spans() == ledger.spans()
