"""Whatever stops the archive: what was durable is found again and the recording goes on without a hole."""

import errno
import os
import signal
import subprocess
import sys

import pytest

from schemas.archive_layout import RecordingState
from services.archive.disk import Disk
from services.archive.manifest import store, with_files, with_state
from services.archive.recovery import recover
from services.archive.seal import seal
from services.archive.writer import SessionWriter
from services.recordings.folder import read_manifest, session_folders, sha256_of, verify
from services.recordings.reader import open_recording

VERSION = "0.1.0"
EVERY_CALL = range(1, 200)


def positions(recovered):
    return {name: place.sequence for name, place in recovered.ledger.positions().items()}


def bring_in_order(folder, description, disk=None):
    """What the service does with a folder after a start."""
    recovered = recover(folder, description, VERSION, disk or Disk())
    entries = [seal(part, "ambula test", disk or Disk(), 4096) for part in recovered.parts]
    manifest = with_files(recovered.manifest, [entry for entry in entries if entry])
    store(folder, with_state(manifest, RecordingState.FINISHED), disk or Disk())
    return recovered


def go_on(folder, description, recovered, records):
    writer = SessionWriter(folder, description, VERSION, ledger=recovered.ledger, first_number=recovered.next_number)
    for record in records:
        writer.write(record)
    writer.flush()
    writer.close()
    return writer


def streams(folder):
    recording = open_recording(folder)
    found = {}
    for record in recording.records():
        found.setdefault(record.stream.name, []).append(record)
    return found


def test_an_open_file_is_found_and_the_recording_goes_on(recorded, tape, description):
    both = [record for pair in zip(tape.walk(50), tape.walk(50, tape.joints), strict=True) for record in pair]
    folder = recorded(both, closed=False)
    recovered = recover(folder, None, VERSION, Disk())
    assert positions(recovered) == {"imu/hub": 49, "joint_state/estimation": 49}
    assert recovered.next_number == 1
    writer = go_on(folder, description, recovered, [*tape.walk(70), *tape.walk(70, tape.joints)])
    assert (writer.counts.written, writer.counts.duplicated) == (40, 100)
    bring_in_order(folder, description)
    assert streams(folder) == {"imu/hub": tape.walk(70), "joint_state/estimation": tape.walk(70, tape.joints)}
    assert verify(folder) == []


def test_a_corrupt_open_file_is_kept_and_the_rest_asked_for_again(recorded, tape, description):
    folder = recorded(tape.walk(60), closed=False)
    part = folder / "raw.mcap.part"
    data = bytearray(part.read_bytes())
    # Past the schemas at the head, within the last chunks of samples.
    data[len(data) * 19 // 20] ^= 1
    part.write_bytes(data)
    recovered = bring_in_order(folder, description)
    assert 0 < positions(recovered)["imu/hub"] < 59
    assert (folder / "raw.mcap.part.damaged").read_bytes() == data
    go_on(folder, description, recovered, tape.walk(60))
    bring_in_order(folder, description)
    assert streams(folder) == {"imu/hub": tape.walk(60)}
    assert "corrupt" in read_manifest(folder).files[0].damage


def test_an_empty_open_file_is_no_obstacle(tmp_path, description, tape):
    folder = tmp_path / "s1"
    folder.mkdir()
    (folder / "raw.mcap.part").touch()
    recovered = bring_in_order(folder, description)
    assert positions(recovered) == {}
    go_on(folder, description, recovered, tape.walk(3))
    assert streams(folder) == {"imu/hub": tape.walk(3)}


def test_a_file_that_was_closed_already_is_not_closed_again(recorded, tape):
    """Killed after the rename and before the open file was removed."""
    folder = recorded(tape.walk(20), closed=False)
    part = (folder / "raw.mcap.part").read_bytes()
    recorded(tape.walk(20), folder=folder.parent / "twin")
    (folder.parent / "twin" / "raw.mcap").rename(folder / "raw.mcap")
    (folder / "raw.mcap.sealing").write_bytes(part[:100])
    recovered = recover(folder, None, VERSION, Disk())
    assert recovered.parts == []
    assert sorted(path.name for path in folder.iterdir()) == ["manifest.json", "raw.mcap"]
    assert positions(recovered) == {"imu/hub": 19}


def test_a_manifest_that_cannot_be_read_is_made_anew(recorded, tape):
    folder = recorded([*tape.walk(30), tape.record(tape.hub, 30, final=True)])
    before = read_manifest(folder)
    (folder / "manifest.json").write_text("{")
    recovered = recover(folder, None, VERSION, Disk())
    assert recovered.manifest.files == before.files
    assert recovered.ledger.positions()["imu/hub"].ended
    assert verify(folder) == []


def test_a_recording_keeps_its_version_when_ambula_is_renewed(recorded, tape, description):
    folder = recorded([*tape.walk(5), *tape.walk(5, tape.joints)])
    for newer in ("0.2.0", "0.1.0"):
        recovered = recover(folder, description, newer, Disk())
        assert recovered.manifest.derived_version == VERSION
        assert positions(recovered) == {"imu/hub": 4, "joint_state/estimation": 4}
        (folder / "manifest.json").unlink()
        assert recover(folder, description, newer, Disk()).manifest.derived_version == VERSION


def test_folders_of_sessions_are_found(recorded, tape, tmp_path):
    recorded(tape.walk(3))
    (tmp_path / "other").mkdir()
    (tmp_path / "file").touch()
    assert [folder.name for folder in session_folders(tmp_path)] == ["s1"]
    assert session_folders(tmp_path / "missing") == []
    assert recover(tmp_path / "other", None, VERSION, Disk()) is None


def test_altered_and_missing_files_are_named(recorded, tape):
    folder = recorded([*tape.walk(30), *tape.walk(30, tape.joints)])
    (folder / "derived-0.1.0.mcap").unlink()
    with (folder / "raw.mcap").open("ab") as file:
        file.write(b"x")
    assert [line.split(":")[0] for line in sorted(verify(folder))] == ["derived-0.1.0.mcap", "raw.mcap"]
    (folder / "manifest.json").unlink()
    assert "manifest" in verify(folder)[0]


@pytest.mark.parametrize("forever", [False, True], ids=["once", "for ever"])
def test_every_disk_error_while_recording(tmp_path, description, tape, failing_disk, forever):
    """The n-th create, write, sync or rename fails, n = 1, 2, ...: what was durable is found, the rest follows."""
    records = tape.walk(40)
    for fail_at in EVERY_CALL:
        folder = tmp_path / f"{fail_at}"
        folder.mkdir()
        disk = failing_disk(fail_at, errno.ENOSPC, forever)
        durable = record_until_error(folder, description, records, disk)
        recovered = recover(folder, description, VERSION, Disk())
        held = positions(recovered).get("imu/hub", -1)
        assert held >= durable
        go_on(folder, description, recovered, records)
        bring_in_order(folder, description)
        assert streams(folder) == {"imu/hub": records}
        assert verify(folder) == []
        if not disk.failed:
            return
    pytest.fail("the failures never came to an end")


def record_until_error(folder, description, records, disk):
    """The last sequence number that was promised to be safe."""
    writer = SessionWriter(folder, description, VERSION, disk=disk)
    try:
        for place, record in enumerate(records):
            writer.write(record)
            if place % 10 == 9:
                writer.flush()
    except OSError:
        pass
    writer.close()
    return writer.durable.positions.get("imu/hub", -1)


@pytest.mark.parametrize("damaged", [False, True])
def test_every_disk_error_while_closing(recorded, tape, description, failing_disk, tmp_path, damaged):
    """Closing a file fails at the n-th call, and is done again."""
    records = tape.walk(40)
    for fail_at in EVERY_CALL:
        folder = recorded(records, closed=False, folder=tmp_path / f"{fail_at}")
        if damaged:
            with (folder / "raw.mcap.part").open("ab") as file:
                file.write(b"\x99" * 20)
        disk = failing_disk(fail_at)
        try:
            bring_in_order(folder, description, disk)
        except OSError:
            assert disk.failed
        bring_in_order(folder, description)
        assert streams(folder) == {"imu/hub": records}
        assert verify(folder) == []
        assert not list(folder.glob("*.tmp")) + list(folder.glob("*.sealing")) + list(folder.glob("*.part"))
        if not disk.failed:
            return
    pytest.fail("the failures never came to an end")


RECORD_FOR_EVER = """
import sys
from pathlib import Path
from schemas.session import SessionDescription
from schemas.signals import IMU
from services.recordings.record import Record
from services.archive.writer import SessionWriter
from services.flow.message import Envelope, Stream
folder, text, limit = sys.argv[1:]
if int(limit):
    import resource, signal
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(limit), int(limit)))
writer = SessionWriter(Path(folder), SessionDescription.model_validate_json(text), "0.1.0")
number = 0
while True:
    for _ in range(10):
        payload = b'{"n":%d,"noise":"%d"}' % (number, hash((number, 1)))
        writer.write(Record(Stream(IMU, "hub"), Envelope(0, number, number * 10**7), payload, 0))
        number += 1
    try:
        writer.flush()
    except OSError as error:
        print("error", error.errno, flush=True)
        sys.exit(3)
    print(writer.durable.positions["imu/hub"], flush=True)
"""


def recorder(folder, description, limit=0):
    command = [sys.executable, "-c", RECORD_FOR_EVER, str(folder), description.model_dump_json(), str(limit)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True)


@pytest.mark.system
@pytest.mark.parametrize("lines", [1, 2, 3, 7, 20, 53, 101, 230, 400, 555])
def test_a_killed_recorder_keeps_what_it_had_promised(tmp_path, description, lines):
    process = recorder(tmp_path, description)
    with process:
        for _ in range(lines):
            promised = int(process.stdout.readline())
        os.kill(process.pid, signal.SIGKILL)
    recovered = bring_in_order(tmp_path, description)
    assert positions(recovered)["imu/hub"] >= promised
    found = streams(tmp_path)["imu/hub"]
    assert [record.envelope.sequence for record in found] == list(range(len(found)))
    assert all(record.payload.startswith(b'{"n":%d,' % place) for place, record in enumerate(found))
    assert verify(tmp_path) == []


@pytest.mark.system
def test_a_full_disk_ends_the_file_not_the_recording(tmp_path, description):
    process = recorder(tmp_path, description, limit=100_000)
    output = process.communicate()[0].split("\n")
    assert process.returncode == 3
    assert output[-2] == f"error {errno.EFBIG}"
    recovered = bring_in_order(tmp_path, description)
    assert positions(recovered)["imu/hub"] == int(output[-3])
    assert sha256_of(tmp_path / "raw.mcap") == read_manifest(tmp_path).files[0].sha256
