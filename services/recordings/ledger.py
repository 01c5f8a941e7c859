"""Bookkeeping of sequence numbers: what a file or a recording holds of each stream, without holes."""

from copy import copy
from dataclasses import dataclass, field

from schemas.archive_layout import StreamSpan
from schemas.checkpoint import StreamPosition


@dataclass
class Span:
    """A run of sequence numbers of one epoch, as it grows."""

    stream: str
    epoch: int
    first: int
    last: int
    count: int
    captured_ns: int
    ended: bool

    def entry(self) -> StreamSpan:
        """As it stands in the manifest."""
        return StreamSpan(
            stream=self.stream,
            epoch=self.epoch,
            first_sequence=self.first,
            last_sequence=self.last,
            count=self.count,
            last_captured_ns=self.captured_ns,
            ended=self.ended,
        )


@dataclass
class Ledger:
    """The newest span of each stream, and the spans of earlier epochs."""

    newest: dict[str, Span] = field(default_factory=dict)
    earlier: list[Span] = field(default_factory=list)

    def copy(self) -> "Ledger":
        """An independent copy."""
        return Ledger({name: copy(span) for name, span in self.newest.items()}, list(self.earlier))

    def expected(self, stream: str, epoch: int) -> int | None:
        """The sequence number that must come next; None when the epoch is new, -1 when it is over."""
        span = self.newest.get(stream)
        if span is None or epoch > span.epoch:
            return None
        return span.last + 1 if epoch == span.epoch else -1

    def advance(self, stream: str, epoch: int, first: int, last: int) -> Span:
        """first..last have been dealt with; they follow on what is known of the epoch."""
        span = self.newest.get(stream)
        if span is None or epoch > span.epoch:
            if span is not None:
                self.earlier.append(span)
            span = self.newest[stream] = Span(stream, epoch, first, last, 0, 0, False)
        span.last = last
        return span

    def count(self, stream: str, epoch: int, sequence: int, captured_ns: int, *, final: bool) -> None:
        """One message has been dealt with."""
        span = self.advance(stream, epoch, sequence, sequence)
        span.count += 1
        span.captured_ns = max(span.captured_ns, captured_ns)
        span.ended = final

    def positions(self) -> dict[str, StreamPosition]:
        """The last message of each stream."""
        return {
            name: StreamPosition(epoch=span.epoch, sequence=span.last, ended=span.ended)
            for name, span in self.newest.items()
        }

    def spans(self) -> list[StreamSpan]:
        """Every span, for the manifest."""
        return [span.entry() for span in (*self.earlier, *self.newest.values())]

    def captured_ns(self) -> int:
        """Newest session time of all streams, ns."""
        return max((span.captured_ns for span in self.newest.values()), default=0)

    def messages(self) -> int:
        """Number of messages in all spans."""
        return sum(span.count for span in (*self.earlier, *self.newest.values()))

    def absorb(self, spans: list[StreamSpan]) -> None:
        """Take over what a later file holds."""
        for entry in spans:
            span = self.newest.get(entry.stream)
            if span is not None and (entry.epoch, entry.last_sequence) <= (span.epoch, span.last):
                continue
            span = self.advance(entry.stream, entry.epoch, entry.first_sequence, entry.last_sequence)
            span.count += entry.count
            span.captured_ns = max(span.captured_ns, entry.last_captured_ns)
            span.ended = entry.ended
