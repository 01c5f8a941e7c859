"""What several streams bring at once when a node starts or resumes, in the order in which it was captured.

Rings answer one after the other. A node that waits for a late stream by captured time only would take a stream whose
answer comes later for one that is away, and resume to other numbers than those it had sent.
"""

from collections import deque
from collections.abc import Callable, Iterable
from typing import Generic, TypeVar

from services.flow.message import Stream

Item = TypeVar("Item")


class CatchUp(Generic[Item]):
    """Holds what comes until every stream has something, or is known to have no more."""

    def __init__(self, streams: Iterable[Stream], captured_ns: Callable[[Item], int]) -> None:
        self._captured_ns = captured_ns
        self._waiting: dict[Stream, deque[Item]] = {stream: deque() for stream in streams}

    def add(self, stream: Stream, item: Item) -> None:
        """Take the next item of a stream."""
        self._waiting[stream].append(item)

    def ready(self, settled: Iterable[Stream]) -> list[Item]:
        """Items whose turn has come, given the streams that have answered with all they had.

        Those of equal time in the order of the streams.
        """
        silent = set(settled)
        out: list[Item] = []
        while all(items or stream in silent for stream, items in self._waiting.items()):
            first = min((items for items in self._waiting.values() if items), key=self._first_ns, default=None)
            if first is None:
                break
            out.append(first.popleft())
        return out

    def _first_ns(self, items: deque[Item]) -> int:
        return self._captured_ns(items[0])

    def is_over(self, settled: Iterable[Stream]) -> bool:
        """Every stream has answered, and nothing is held."""
        return not any(self._waiting.values()) and set(settled) >= self._waiting.keys()
