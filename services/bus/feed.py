"""All streams of one signal through one subscription."""

from collections.abc import Callable

from schemas.signals import Signal, stream_key
from services.bus.connection import Bus
from services.bus.queue import BoundedQueue
from services.bus.received import Handle, Received


class SignalFeed:
    """Subscribes once for all sessions and sources (each subscription costs a thread) and sorts by key."""

    def __init__(self, bus: Bus, signal: Signal, queue: BoundedQueue) -> None:
        self._takers: dict[str, tuple[str, Callable[[Received], None]]] = {}
        self._queue = queue
        self._handle = bus.subscribe_recovering(stream_key(bus.settings.site, "*", signal, "*"), self._arrive)

    def add(self, key: str, name: str, take: Callable[[Received], None]) -> Handle:
        """Hand what comes for `key` to `take`, through the queue, until the handle is closed."""
        self._takers[key] = (name, take)
        return Handle(lambda: self._remove(key))

    def close(self) -> None:
        """Unsubscribe."""
        self._handle.close()

    def _remove(self, key: str) -> None:
        self._takers.pop(key, None)

    def _arrive(self, received: Received) -> None:
        taker = self._takers.get(received.key)
        if taker is not None:
            self._queue.offer(taker[0], taker[1], received)
