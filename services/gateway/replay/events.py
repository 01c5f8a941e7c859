"""What happened in a stretch of a recording."""

from collections.abc import Iterable, Iterator

from schemas.gait import GaitEvent
from schemas.imu import ImuBatch
from schemas.signals import GAIT_EVENT
from schemas.skeleton import SkeletonBatch
from schemas.standing import StandingMark
from services.flow.message import decode_payload
from services.gateway.replay.losses import is_marked
from services.gateway.replay.models import ContactOut, LossOut, MarkedOut
from services.gateway.replay.statuses import losses_between
from services.recordings.ranges import RecordedRanges
from services.recordings.record import Record


def contacts(recording: RecordedRanges, from_ns: int, to_ns: int) -> list[ContactOut]:
    """In the order of time. Raises DamagedRecording, DecodeError, OSError."""
    found = []
    for stream, envelope, payload, _ in recording.read(recording.find(GAIT_EVENT, from_ns, to_ns)):
        event = decode_payload(stream.signal, envelope, payload)
        if isinstance(event, GaitEvent):
            at_s = event.captured_ns / 1e9
            found.append(ContactOut(event=event.kind, side=event.side, at_s=at_s, time_std_s=event.time_std_s))
    return sorted(found, key=lambda contact: contact.at_s)


class Marks:
    """Those given from `from_ns` on; a mark travels with samples of every hub and camera, and counts once."""

    def __init__(self, from_ns: int) -> None:
        self._from_ns = from_ns
        self._found: set[tuple[int, int, int]] = set()

    def seen(self, records: Iterable[Record]) -> Iterator[Record]:
        """The same raw messages; the marks among them are kept. Raises DecodeError."""
        for record in records:
            if is_marked(record):
                batch = decode_payload(record.stream.signal, record.envelope, record.payload)
                if isinstance(batch, ImuBatch | SkeletonBatch):
                    self._found |= {_span(mark) for mark in batch.marks if mark.given_ns >= self._from_ns}
            yield record

    def out(self) -> list[MarkedOut]:
        """In the order in which they were given."""
        return [MarkedOut(from_s=a / 1e9, to_s=b / 1e9, given_s=given / 1e9) for given, a, b in sorted(self._found)]


def _span(mark: StandingMark) -> tuple[int, int, int]:
    return mark.given_ns, mark.from_ns, mark.to_ns


def lost(recording: RecordedRanges, from_ns: int, to_ns: int, marks: Marks) -> list[LossOut]:
    """Losses that go on in it, by their start; the marks that stand in the same messages go to `marks`.

    Raises DamagedRecording, DecodeError, OSError.
    """
    return [
        LossOut(
            source=loss.source,
            kind=loss.kind,
            start_s=loss.start_ns / 1e9,
            end_s=None if loss.end_ns is None else loss.end_ns / 1e9,
        )
        for loss in losses_between(recording, from_ns, to_ns, marks.seen)
    ]
