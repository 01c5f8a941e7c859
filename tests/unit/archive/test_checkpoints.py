import json
import threading

import pytest

from schemas.checkpoint import Checkpoint, StreamPosition
from services.archive.checkpoints import CheckpointKeeper
from services.archive.disk import Disk
from services.archive.parameters import ArchiveParameters


def checkpoint(sequence, session="s1", service="estimation", state=None):
    place = StreamPosition(epoch=0, sequence=sequence, ended=False)
    return (
        Checkpoint(
            service=service,
            session=session,
            captured_ns=sequence,
            inputs={"imu/hub": place},
            outputs={},
            state=state or {"n": sequence},
        )
        .model_dump_json()
        .encode()
    )


@pytest.fixture
def keeper(tmp_path):
    keeper = CheckpointKeeper(tmp_path, Disk(), ArchiveParameters(checkpoint_bytes=10_000))
    yield keeper
    keeper.stop()


def test_the_newest_is_handed_out_and_survives_a_restart(keeper, tmp_path):
    for sequence in range(5):
        assert keeper.take("s1", "estimation", checkpoint(sequence))
    assert keeper.newest("s1", "estimation") == checkpoint(4)
    assert keeper.wait()
    again = CheckpointKeeper(tmp_path, Disk(), ArchiveParameters())
    assert again.newest("s1", "estimation") == checkpoint(4)
    assert again.newest("s1", "metrics") is None
    again.stop()


def test_one_that_lies_behind_is_not_taken(keeper, tmp_path):
    """A process that was frozen wakes up and sends what it had; its successor is further."""
    keeper.take("s1", "estimation", checkpoint(7))
    assert not keeper.take("s1", "estimation", checkpoint(6))
    assert keeper.newest("s1", "estimation") == checkpoint(7)
    keeper.wait()
    again = CheckpointKeeper(tmp_path, Disk(), ArchiveParameters())
    assert not again.take("s1", "estimation", checkpoint(3))
    again.stop()


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"{",
        b"\xff",
        b"[]",
        checkpoint(1, session="other"),
        checkpoint(1, service="metrics"),
        checkpoint(1, state={"n": "x" * 20_000}),
    ],
)
def test_what_is_no_checkpoint_of_the_place_is_refused(keeper, data):
    assert not keeper.take("s1", "estimation", data)
    assert keeper.newest("s1", "estimation") is None
    assert keeper.refused == 1


def test_a_place_outside_the_data_folder_is_never_touched(keeper, tmp_path):
    evil = checkpoint(1, session="../x")
    keeper.take("../x", "estimation", evil)
    keeper.wait()
    assert not (tmp_path.parent / "x").exists()
    assert keeper.newest("../../etc", "passwd") is None


def test_a_disk_that_refuses_costs_the_file_only(tmp_path, failing_disk):
    for fail_at in range(1, 7):
        folder = tmp_path / f"{fail_at}"
        keeper = CheckpointKeeper(folder, failing_disk(fail_at), ArchiveParameters())
        keeper.take("s1", "estimation", checkpoint(1))
        keeper.wait()
        assert keeper.newest("s1", "estimation") == checkpoint(1)
        keeper.take("s1", "estimation", checkpoint(2))
        keeper.stop()
        kept = json.loads((folder / "s1" / "checkpoint-estimation.json").read_bytes())
        assert kept["inputs"]["imu/hub"]["sequence"] == 2
        assert keeper.failures == 1


def test_memory_is_bounded_and_the_file_remains(tmp_path):
    keeper = CheckpointKeeper(tmp_path, Disk(), ArchiveParameters(checkpoints_in_memory=2))
    for number in range(6):
        keeper.take(f"s{number}", "metrics", checkpoint(number, f"s{number}", "metrics"))
        keeper.wait()
    assert len(keeper._kept) == 2
    assert all(keeper.newest(f"s{n}", "metrics") == checkpoint(n, f"s{n}", "metrics") for n in range(6))
    keeper.stop()


def test_many_threads_may_ask_and_give(keeper):
    def give(service):
        for sequence in range(50):
            keeper.take("s1", service, checkpoint(sequence, service=service))
            assert keeper.newest("s1", service) is not None

    threads = [threading.Thread(target=give, args=(f"n{number}",)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(keeper.newest("s1", f"n{number}") == checkpoint(49, service=f"n{number}") for number in range(4))


def test_nothing_is_kept_or_written_of_a_session_that_was_erased(keeper, tmp_path):
    keeper.take("s1", "estimation", checkpoint(1))
    keeper.take("s2", "estimation", checkpoint(1, session="s2"))
    keeper.forget("s1")
    assert not keeper.take("s1", "estimation", checkpoint(2))
    assert keeper.newest("s1", "estimation") is None
    assert keeper.newest("s2", "estimation") == checkpoint(1, session="s2")
    assert keeper.wait()
