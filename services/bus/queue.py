"""What waits to be dealt with by the one consumer thread of a process."""

import queue
from collections import Counter
from collections.abc import Callable
from typing import Any, NamedTuple


class Task(NamedTuple):
    """One call that waits."""

    action: Callable[[Any], None]
    argument: Any


class BoundedQueue:
    """Data is dropped and counted when the queue is full; control always gets in. Safe from any thread.

    The bound is checked without a lock, so that each producing thread may overshoot it by one.
    """

    def __init__(self, capacity: int = 20_000) -> None:
        self.capacity = capacity
        self.dropped: Counter[str] = Counter()
        self._tasks: queue.SimpleQueue[Task] = queue.SimpleQueue()

    def __len__(self) -> int:
        return self._tasks.qsize()

    @property
    def dropped_total(self) -> int:
        """Dropped data of all subjects."""
        return sum(list(self.dropped.values()))

    def offer(self, subject: str, action: Callable[[Any], None], argument: Any) -> bool:
        """Add data of `subject`; False, and counted, when there is no room."""
        if self._tasks.qsize() >= self.capacity:
            self.dropped[subject] += 1
            return False
        self._tasks.put(Task(action, argument))
        return True

    def post(self, action: Callable[[Any], None], argument: Any = None) -> None:
        """Add control, whatever the length."""
        self._tasks.put(Task(action, argument))

    def take(self, timeout_s: float) -> Task | None:
        """The next one in order of arrival; None after `timeout_s` without any."""
        try:
            return self._tasks.get(timeout=timeout_s) if timeout_s > 0 else self._tasks.get_nowait()
        except queue.Empty:
            return None
