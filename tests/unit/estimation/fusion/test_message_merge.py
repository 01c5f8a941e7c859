"""Order by captured time, whatever came first."""

import itertools

from schemas.imu import ImuBatch
from schemas.signals import IMU, SKELETON
from schemas.skeleton import SkeletonBatch
from services.estimation.fusion.merge import MessageMerge
from services.flow.message import Envelope, Message, Stream

HUB, CAMERA = Stream(IMU, "hub"), Stream(SKELETON, "camera")
MS = 1_000_000
LATENESS_NS = 100 * MS


def message(stream: Stream, at_ms: int, sequence: int = 0) -> Message:
    if stream is HUB:
        return Message(stream, Envelope(0, sequence, at_ms * MS), ImuBatch(sensors=[], marks=[]))
    frame = SkeletonBatch(captured_ns=[], body=[], people=[], position=[], state=[], marks=[])
    return Message(stream, Envelope(0, sequence, at_ms * MS), frame)


def times(messages) -> list[tuple[str, int]]:
    return [(each.stream.source, each.envelope.captured_ns // MS) for each in messages]


def passed(merge: MessageMerge, order) -> list[tuple[str, int]]:
    out = [ready for each in order for ready in merge.accept(each)]
    return times(out + merge.finish())


def test_any_order_of_arrival_within_the_lateness_gives_the_same_order():
    hub = [message(HUB, 10 * k, k) for k in range(8)]
    camera = [message(CAMERA, 33 * k, k) for k in range(3)]
    expected = sorted(times(hub + camera), key=lambda each: (each[1], each[0] != "hub"))
    for late in range(4):
        merged = list(itertools.chain(hub[:late], camera[:1], hub[late:6], camera[1:], hub[6:]))
        assert passed(MessageMerge((HUB, CAMERA), LATENESS_NS), merged) == expected


def test_nothing_waits_for_a_stream_that_is_away_longer_than_the_lateness():
    merge = MessageMerge((HUB, CAMERA), LATENESS_NS)
    merge.accept(message(CAMERA, 0))
    out = [ready for k in range(100) for ready in merge.accept(message(HUB, 10 * k, k))]
    assert times(out)[-1] == ("hub", 990 - 100)
    assert times(merge.accept(message(CAMERA, 400, 1))) == [("camera", 400)]


def test_what_waits_survives_a_snapshot():
    merge = MessageMerge((HUB, CAMERA), LATENESS_NS)
    for k in range(5):
        merge.accept(message(HUB, 10 * k, k))
    resumed = MessageMerge((HUB, CAMERA), LATENESS_NS)
    resumed.restore(merge.snapshot())
    late = message(CAMERA, 35)
    assert [(each.envelope, each.payload) for each in resumed.accept(late)] == [
        (each.envelope, each.payload) for each in merge.accept(late)
    ]
    assert times(resumed.finish()) == times(merge.finish()) == [("hub", 40)]
