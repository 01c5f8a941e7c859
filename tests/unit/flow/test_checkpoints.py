"""A checkpoint waits for those who read the outputs."""

from schemas.checkpoint import Checkpoint, StreamPosition
from services.flow.checkpoints import LONGEST_WAIT_S, HeldCheckpoints


def checkpoint(sequence: int) -> Checkpoint:
    outputs = {
        name: StreamPosition(epoch=0, sequence=sequence, ended=False)
        for name in ("joint_state/estimation", "live_pose/estimation")
    }
    return Checkpoint(service="estimation", session="s", captured_ns=sequence, inputs={}, outputs=outputs, state={})


def test_without_readers_nothing_waits():
    held = HeldCheckpoints()
    held.add(0.0, checkpoint(5))
    assert held.release(0.0) == checkpoint(5)
    assert held.empty


def test_the_newest_that_every_reader_has_is_released():
    held = HeldCheckpoints()
    held.progress("archive", {"joint_state/estimation": 25})
    held.progress("segmentation", {"joint_state/estimation": 19})
    for second, sequence in enumerate((10, 20, 30)):
        held.add(second, checkpoint(sequence))
    assert held.release(3.0) == checkpoint(10)
    assert held.release(3.0) is None
    held.progress("segmentation", {"joint_state/estimation": 40})
    assert held.release(3.0) == checkpoint(20)
    held.progress("archive", {"joint_state/estimation": 40})
    assert held.release(3.0) == checkpoint(30)


def test_the_archive_reads_every_archived_stream_others_what_they_report():
    held = HeldCheckpoints()
    held.progress("metrics", {"stride/segmentation": 3})
    held.add(0.0, checkpoint(0))
    assert held.release(0.0) == checkpoint(0)
    held.progress("archive", {"imu/hub": 9})
    held.add(0.0, checkpoint(1))
    assert held.release(0.0) is None
    held.progress("archive", {"imu/hub": 9, "joint_state/estimation": 1})
    assert held.release(0.0) == checkpoint(1)


def test_a_reader_that_has_gone_is_not_waited_for():
    held = HeldCheckpoints()
    held.progress("archive", {})
    held.add(0.0, checkpoint(1))
    assert held.release(LONGEST_WAIT_S - 0.1) is None
    assert held.release(LONGEST_WAIT_S) == checkpoint(1)


def test_what_nobody_sent_is_covered():
    held = HeldCheckpoints()
    held.progress("archive", {})
    held.add(0.0, checkpoint(-1))
    assert held.release(0.0) == checkpoint(-1)
