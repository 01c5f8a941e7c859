"""The last instants, and how movements are found in them."""

from bisect import bisect_left
from collections.abc import Callable
from itertools import pairwise
from operator import attrgetter

from services.flow.node import State
from services.segmentation.timed_up_and_go.instants import Instant

Quantity = Callable[[Instant], float | None]


class Trace:
    """Instants in order, no more than a memory of them."""

    def __init__(self, memory_s: float) -> None:
        self._memory_ns = round(memory_s * 1e9)
        self.instants: list[Instant] = []

    def append(self, new: Instant) -> None:
        """Take the newest instant."""
        self.instants.append(new)
        if self.instants[0].captured_ns < new.captured_ns - self._memory_ns:
            del self.instants[0]

    def clear(self) -> None:
        """Forget everything."""
        self.instants.clear()

    def index_of(self, captured_ns: int) -> int:
        """The first instant that is not before a time."""
        return bisect_left(self.instants, captured_ns, key=attrgetter("captured_ns"))

    def since(self, captured_ns: int) -> list[Instant]:
        """From a time on."""
        return self.instants[self.index_of(captured_ns) :]

    def unsure_s(self, at_ns: int, noted_gap_s: float) -> float:
        """Half the length, s, of the gaps within or beside which a time lies: a boundary may be anywhere in them."""
        first = max(1, self.index_of(at_ns) - 2)
        ends = [each.captured_ns for each in self.instants[first - 1 : first + 5]]
        gaps = [later - earlier for earlier, later in pairwise(ends) if later - earlier > noted_gap_s * 1e9]
        return 0.5e-9 * sum(gaps)

    def last_above(self, quantity: Quantity, level: float, before: int | None = None) -> int | None:
        """Index of the newest instant, before an index, whose quantity is at least a level."""
        for i in range((len(self.instants) if before is None else before) - 1, -1, -1):
            value = quantity(self.instants[i])
            if value is not None and value >= level:
                return i
        return None

    def begins_ns(self, rate: Quantity, peak: int, share: float) -> int:
        """When the movement that is fastest at index `peak` began: its rate passes a share of the peak's, in between
        two instants; the oldest instant when it never was so slow."""
        return self._passes(rate, peak, share, -1)

    def ends_ns(self, rate: Quantity, peak: int, share: float) -> int | None:
        """When it was over; None while it goes on."""
        newest, most = rate(self.instants[-1]), rate(self.instants[peak])
        at = self._passes(rate, peak, share, 1)
        goes_on = newest is not None and most is not None and newest > share * most
        return None if goes_on and at == self.instants[-1].captured_ns else at

    def fastest(self, rate: Quantity, first: int, last: int) -> int | None:
        """Index of the largest rate from `first` up to and without `last`."""
        known = [(value, i) for i in range(first, last) if (value := rate(self.instants[i])) is not None]
        return max(known)[1] if known else None

    def _passes(self, rate: Quantity, peak: int, share: float, way: int) -> int:
        level = share * (rate(self.instants[peak]) or 0.0)
        i = peak
        while 0 <= i + way < len(self.instants):
            here, there = self.instants[i], self.instants[i + way]
            fast, slow = rate(here), rate(there)
            if fast is None or slow is None:
                return here.captured_ns
            if slow <= level:
                part = (fast - level) / (fast - slow) if fast > slow else 0.0
                return here.captured_ns + round(part * (there.captured_ns - here.captured_ns))
            i += way
        return self.instants[i].captured_ns

    def snapshot(self) -> State:
        """The instants as rows."""
        return {"instants": [list(each) for each in self.instants]}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.instants = [Instant(*row) for row in state["instants"]]
