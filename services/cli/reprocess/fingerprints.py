"""Whether two runs said the same: each message of each stream as a few bytes."""

from dataclasses import dataclass, field
from hashlib import blake2b

from services.flow.message import Envelope


@dataclass(frozen=True, slots=True)
class StreamDifference:
    """Where a stream begins to differ: the message number of the first that is not the same, from 0."""

    stream: str
    stored: int
    recomputed: int
    first: int


@dataclass
class Fingerprints:
    """Messages by stream, in order. Numbers and epochs do not count: a restart begins new ones."""

    streams: dict[str, list[bytes]] = field(default_factory=dict)

    def add(self, stream: str, envelope: Envelope, payload: bytes) -> None:
        """Take the next message of a stream."""
        mark = blake2b(f"{envelope.captured_ns} {envelope.final} ".encode() + payload, digest_size=8).digest()
        self.streams.setdefault(stream, []).append(mark)

    def differing_from(self, recomputed: "Fingerprints", *, complete: bool) -> list[StreamDifference]:
        """Streams in which the recomputed messages are others; if not `complete`, these may end earlier."""
        found = []
        for stream in sorted({*self.streams, *recomputed.streams}):
            mine, theirs = self.streams.get(stream, []), recomputed.streams.get(stream, [])
            differing = (place for place, pair in enumerate(zip(mine, theirs, strict=False)) if pair[0] != pair[1])
            first = next(differing, min(len(mine), len(theirs)))
            if first < len(mine) or (complete and first < len(theirs)):
                found.append(StreamDifference(stream, len(mine), len(theirs), first))
        return found
