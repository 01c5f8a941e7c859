"""Datagrams back in the order in which they were sent: some are late, some come twice, some never. Pure."""

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Generic, TypeVar

Item = TypeVar("Item")


class Outcome(StrEnum):
    """What became of a datagram on arrival."""

    TAKEN = "taken"
    DUPLICATE = "duplicate"
    LATE = "late"


@dataclass(frozen=True, slots=True)
class SequenceParameters:
    """When to stop waiting."""

    wait_ns: int = 60_000_000  # ns that frames wait for one that is missing before them; two frames
    remembered: int = 256  # newest numbers of which it is known whether they came
    farthest_ahead: int = 10_000  # a number further ahead is that of a sender that began anew; five minutes of frames
    restart_after: int = 5  # frames in a row, each after the other, that come as if of long ago: a new count


SEQUENCE = SequenceParameters()


@dataclass
class Sequence(Generic[Item]):
    """Delivers items by rising number. For one sender at a time; `restart` when another takes over.

    sent = delivered + lost + late, once nothing is held: a number that was given up as lost and comes later is late,
    and no more lost.
    """

    parameters: SequenceParameters = SEQUENCE
    delivered: int = 0
    lost: int = 0
    late: int = 0
    duplicates: int = 0
    _next: int | None = None
    _held: dict[int, tuple[int, Item]] = field(default_factory=dict)
    _given_up: set[int] = field(default_factory=set)
    _first: int = 0
    _last_old: int | None = None
    _old_run: int = 0

    def add(self, number: int, now_ns: int, item: Item) -> list[Item]:
        """Take an item that arrived now; what can be delivered, in order."""
        if self._next is None:
            self._next = self._first = number
        if number - self._next > self.parameters.farthest_ahead:
            return [*self.restart(), *self.add(number, now_ns, item)]
        if number >= self._next:
            self._last_old, self._old_run = None, 0
            if number in self._held:
                self.duplicates += 1
            else:
                self._held[number] = (now_ns, item)
            return self._ready()
        return self._take_old(number, now_ns, item)

    def due(self, now_ns: int) -> list[Item]:
        """What has waited long enough for those before it."""
        out: list[Item] = []
        while self._held:
            number = min(self._held)
            if now_ns - min(arrived for arrived, _ in self._held.values()) < self.parameters.wait_ns:
                break
            self._give_up(number)
            out += self._ready()
        return out

    def restart(self) -> list[Item]:
        """Another sender counts from here on; what was held."""
        out: list[Item] = []
        while self._held:
            self._give_up(min(self._held))
            out += self._ready()
        self._next = self._last_old = None
        self._old_run = 0
        self._given_up.clear()
        return out

    def _take_old(self, number: int, now_ns: int, item: Item) -> list[Item]:
        """Late or known; but a run of them, each after the other, is a sender that counts anew."""
        assert self._next is not None, "add knows the next number before it asks for older ones"
        self._old_run = self._old_run + 1 if number - 1 == self._last_old else 1
        self._last_old = number
        if self._old_run >= self.parameters.restart_after:
            return [*self.restart(), *self.add(number, now_ns, item)]
        if number in self._given_up:
            self._given_up.discard(number)
            self.lost -= 1
            self.late += 1
        elif number >= max(self._first, self._next - self.parameters.remembered):
            self.duplicates += 1
        else:
            self.late += 1
        return []

    def _ready(self) -> list[Item]:
        assert self._next is not None, "something was added"
        out: list[Item] = []
        while self._next in self._held:
            out.append(self._held.pop(self._next)[1])
            self._next += 1
        self.delivered += len(out)
        return out

    def _give_up(self, until: int) -> None:
        """Count the numbers before `until` as lost."""
        assert self._next is not None, "something is held"
        missing = range(self._next, until)
        self.lost += len(missing)
        self._given_up |= set(missing[-self.parameters.remembered :])
        self._next = until
        self._given_up = {number for number in self._given_up if number >= until - self.parameters.remembered}
