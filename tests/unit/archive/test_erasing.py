"""A session's folder is gone, whole, however often the disk refuses on the way."""

import itertools

import pytest

from services.archive.disk import Disk
from services.archive.erasing import DOOMED_PREFIX, erase_folder, sweep


def fill(folder):
    (folder / ".reprocess").mkdir(parents=True)
    for name in ("manifest.json", "raw.mcap", "raw_001.mcap.part", ".reprocess/derived.mcap"):
        (folder / name).write_bytes(b"MARKER")
    return folder


def left(data_dir):
    return sorted(path.relative_to(data_dir).as_posix() for path in data_dir.rglob("*"))


def test_the_folder_and_everything_in_it_is_gone(tmp_path):
    fill(tmp_path / "other")
    before = left(tmp_path)
    erase_folder(fill(tmp_path / "a"), Disk())
    assert left(tmp_path) == before
    erase_folder(tmp_path / "a", Disk())
    assert left(tmp_path) == before


def test_a_link_is_removed_and_not_followed(tmp_path):
    fill(tmp_path / "other")
    before = left(tmp_path)
    (tmp_path / "a").symlink_to(tmp_path / "other")
    erase_folder(tmp_path / "a", Disk())
    assert left(tmp_path) == before


def test_after_any_failure_it_is_not_a_recording_any_more_and_trying_again_ends_it(tmp_path, failing_disk):
    for n in itertools.count(1):
        disk = failing_disk(n)
        folder = fill(tmp_path / f"s{n}")
        try:
            erase_folder(folder, disk)
        except OSError:
            if n > 1:
                assert not folder.exists()
            erase_folder(folder, Disk())
            assert left(tmp_path) == []
        if not disk.failed:
            break
    assert n > 5


def test_what_a_kill_left_is_swept_at_the_start(tmp_path):
    fill(tmp_path / f"{DOOMED_PREFIX}a")
    fill(tmp_path / "b")
    sweep(tmp_path, Disk())
    assert [path.name for path in tmp_path.iterdir()] == ["b"]


@pytest.mark.parametrize("session", ["../b", ".", "", "a/b"])
def test_only_a_session_can_be_named(session, tmp_path):
    from services.archive.erasing import Eraser

    fill(tmp_path / "b")
    eraser = Eraser(None, tmp_path / "data", None, None, Disk())
    assert eraser.answer(f'{{"sessions": ["{session}"]}}'.encode()) == b'{"erased": []}'
    assert b"error" in eraser.answer(b"no json")
    assert (tmp_path / "b" / "raw.mcap").exists()
