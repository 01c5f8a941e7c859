"""A producer's memory of what it sent lately, to be asked for again by sequence number."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import islice
from typing import NamedTuple

from services.flow.message import DecodeError, Envelope


class Place(NamedTuple):
    """A message's place in its stream; later ones compare greater."""

    epoch: int
    sequence: int


class RingExtent(NamedTuple):
    """What a ring holds, both ends included."""

    oldest: Place
    newest: Place

    def encode(self) -> bytes:
        """Four words of ASCII: oldest epoch and sequence, newest epoch and sequence."""
        return " ".join(str(number) for number in (*self.oldest, *self.newest)).encode()

    @classmethod
    def decode(cls, data: bytes) -> "RingExtent":
        """Raises DecodeError when the bytes are no extent."""
        try:
            epoch, sequence, last_epoch, last_sequence = (int(word) for word in data.decode("ascii").split(" "))
        except ValueError as error:
            raise DecodeError(f"not the extent of a ring: {data[:64]!r}") from error
        return cls(Place(epoch, sequence), Place(last_epoch, last_sequence))


class Question(NamedTuple):
    """What is missing of a stream: `first` to `last` of one epoch; without `last`, newer epochs too.

    `epoch` None means those numbers of any epoch.
    """

    epoch: int | None
    first: int
    last: int | None


@dataclass
class ReplayRing:
    """The last `keep_s` seconds (of captured time) of one stream, at most `most_bytes` of payload."""

    keep_s: float = 60.0
    most_bytes: int = 64 * 1024 * 1024
    _sent: deque[tuple[Envelope, bytes]] = field(default_factory=deque)
    _bytes: int = 0

    def append(self, envelope: Envelope, payload: bytes) -> None:
        """Remember a message; forget what is too old or too much. The newest always stays."""
        self._sent.append((envelope, payload))
        self._bytes += len(payload)
        oldest_kept_ns = envelope.captured_ns - int(self.keep_s * 1e9)
        while len(self._sent) > 1 and (self._sent[0][0].captured_ns < oldest_kept_ns or self._bytes > self.most_bytes):
            self._bytes -= len(self._sent.popleft()[1])

    def answer(self, question: Question, most: int | None = None) -> list[tuple[Envelope, bytes]]:
        """The first `most` messages asked for, in order."""
        return list(islice(self._matching(question), most))

    def extent(self) -> RingExtent | None:
        """Oldest and newest message held; None when nothing was sent."""
        if not self._sent:
            return None
        oldest, newest = self._sent[0][0], self._sent[-1][0]
        return RingExtent(Place(oldest.epoch, oldest.sequence), Place(newest.epoch, newest.sequence))

    def _matching(self, question: Question) -> Iterator[tuple[Envelope, bytes]]:
        epoch, first, last = question
        for envelope, payload in self._sent:
            asked_epoch = epoch is None or envelope.epoch == epoch
            later_epoch = epoch is not None and last is None and envelope.epoch > epoch
            in_span = envelope.sequence >= first and (last is None or envelope.sequence <= last)
            if later_epoch or (asked_epoch and in_span):
                yield envelope, payload
