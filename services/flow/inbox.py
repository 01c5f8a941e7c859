"""Order out of disorder: one stream's messages by sequence number, each once, holes noticed."""

from dataclasses import dataclass, field
from typing import Generic, NamedTuple, TypeVar

from services.flow.message import Envelope
from services.flow.position import Position

Item = TypeVar("Item")


class Hole(NamedTuple):
    """Sequence numbers that have not come, both ends included."""

    epoch: int
    first: int
    last: int


@dataclass
class InboxCounts:
    """received + lost = highest sequence + 1 (summed over epochs), once nothing waits."""

    received: int = 0
    recovered: int = 0
    duplicated: int = 0
    lost: int = 0


@dataclass
class OrderedInbox(Generic[Item]):
    """Puts a stream's messages in order.

    A message of an older epoch, or with a sequence number that was delivered, is a duplicate. A newer epoch is a
    producer that started again from zero: what waits of the older one is delivered, its holes are given up.
    `most_waiting` bounds the memory: past it the oldest hole is given up.
    """

    position: Position | None = None
    most_waiting: int = 4096
    counts: InboxCounts = field(default_factory=InboxCounts)
    given_up: list[Hole] = field(default_factory=list)
    _waiting: dict[int, tuple[Envelope, Item]] = field(default_factory=dict)

    def accept(self, envelope: Envelope, item: Item, *, recovered: bool = False) -> list[tuple[Envelope, Item]]:
        """Take a message; the messages that are now in order."""
        ready = self._enter_epoch(envelope.epoch)
        assert self.position is not None
        known = envelope.epoch < self.position.epoch or envelope.sequence <= self.position.sequence
        if known or envelope.sequence in self._waiting:
            self.counts.duplicated += 1
            return ready
        self.counts.recovered += recovered
        self._waiting[envelope.sequence] = (envelope, item)
        ready += self._drain()
        while len(self._waiting) > self.most_waiting:
            ready += self.give_up()
        return ready

    def hole(self) -> Hole | None:
        """The first hole before a message that waits, if there is one."""
        if not self._waiting or self.position is None:
            return None
        return Hole(self.position.epoch, self.position.sequence + 1, min(self._waiting) - 1)

    def give_up(self, through: int | None = None) -> list[tuple[Envelope, Item]]:
        """Nobody has the first hole, or its part up to `through`, any more: count it lost and go on behind it."""
        hole = self.hole()
        if hole is None or self.position is None:
            return []
        if through is not None:
            hole = hole._replace(last=min(hole.last, through))
        if hole.last < hole.first:
            return []
        self.given_up.append(hole)
        self.counts.lost += hole.last - hole.first + 1
        self.position = self.position._replace(sequence=hole.last)
        return self._drain()

    def _enter_epoch(self, epoch: int) -> list[tuple[Envelope, Item]]:
        if self.position is not None and epoch <= self.position.epoch:
            return []
        ready = []
        while self._waiting:
            ready += self.give_up()
        self.position = Position(epoch, -1, ended=False)
        return ready

    def _drain(self) -> list[tuple[Envelope, Item]]:
        assert self.position is not None
        ready = []
        sequence = self.position.sequence
        while (entry := self._waiting.pop(sequence + 1, None)) is not None:
            sequence += 1
            ready.append(entry)
        if ready:
            self.counts.received += len(ready)
            ended = ready[-1][0].final
            self.position = Position(self.position.epoch, sequence, ended)
        return ready
