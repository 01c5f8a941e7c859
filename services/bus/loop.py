"""One queue and one thread per process: everything that happens goes through here, in order of arrival."""

import heapq
import itertools
import logging
import queue
import threading
import time
import traceback
from collections.abc import Callable
from typing import Any, TypeVar

from services.bus.connection import Bus
from services.bus.feed import SignalFeed
from services.bus.logs import event
from services.bus.queue import BoundedQueue, Task
from services.bus.received import Handle, Received
from services.bus.receiver import Delivery, StreamReceiver
from services.flow.message import Stream
from services.flow.position import Position

Result = TypeVar("Result")

REPAIR_TICK_S = 0.1
"""How often the receivers look at their holes; a third of the patience with a hole."""

logger = logging.getLogger(__name__)


class EventLoop:
    """The consumer. `run` calls every handler, timer and delivery on the thread it was called from.

    What one of them raises is logged and counted in `errors`; the others go on.
    """

    def __init__(self, bus: Bus, capacity: int = 20_000, stop: threading.Event | None = None) -> None:
        self.bus = bus
        self.queue = BoundedQueue(capacity)
        self.errors = 0
        self._stopped = stop if stop is not None else threading.Event()
        self._timers: list[tuple[float, int, float, Callable[[], None], Handle]] = []
        self._order = itertools.count()
        self._feeds: dict[str, SignalFeed] = {}
        self._receivers: set[StreamReceiver] = set()
        self._side: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        threading.Thread(target=self._work_aside, name="side", daemon=True).start()
        self.every(REPAIR_TICK_S, self._tick_receivers)

    def receive(
        self, session: str, stream: Stream, position: Position | None, deliver: Callable[[Delivery], None]
    ) -> StreamReceiver:
        """Deliver a lossless stream, in order and from behind `position` on (None: from its beginning)."""
        if stream.signal.name not in self._feeds:
            self._feeds[stream.signal.name] = SignalFeed(self.bus, stream.signal, self.queue)
        feed = self._feeds[stream.signal.name]
        receiver = StreamReceiver(self.bus, session, stream, self.queue, position, feed, deliver)
        self._receivers.add(receiver)
        return receiver

    def subscribe(self, key: str, handler: Callable[[Received], None]) -> Handle:
        """Hand what is published under `key` to `handler`: best effort, for live and state signals."""
        return self.bus.subscribe(key, lambda received: self._offer(key, handler, received))

    def post(self, action: Callable[[], None]) -> None:
        """Call `action` soon. From any thread."""
        self.queue.post(_call, action)

    def every(self, period_s: float, action: Callable[[], None]) -> Handle:
        """Call `action` each period until the handle is closed; periods missed under load are not made up for."""
        return self._schedule(period_s, period_s, action)

    def later(self, delay_s: float, action: Callable[[], None]) -> Handle:
        """Call `action` once after a while, unless the handle is closed before."""
        return self._schedule(delay_s, 0.0, action)

    def background(self, work: Callable[[], Result], then: Callable[[Result], None]) -> None:
        """Do slow work on the side thread, one at a time, and hand its result to `then` on the loop."""

        def run() -> None:
            try:
                result = work()
            except Exception:  # noqa: BLE001 - the thread serves other sessions too
                self.report_error("background")
                return
            self.queue.post(then, result)

        self._side.put(run)

    def stop(self) -> None:
        """Make `run` return. From any thread or signal handler."""
        self._stopped.set()
        self.post(_nothing)

    def run(self) -> None:
        """Work until `stop`, or until the event given is set (seen at the next timer)."""
        while not self._stopped.is_set():
            self._step()

    def run_for(self, most_s: float, until: Callable[[], bool]) -> None:
        """Work on, stopped or not, until `until()` holds or the time is over."""
        end = time.monotonic() + most_s
        while time.monotonic() < end and not until():
            self._step(0.02)

    def close(self) -> None:
        """Close receivers and feeds. The bus stays open."""
        self._side.put(None)
        for receiver in self._receivers:
            receiver.close()
        for feed in self._feeds.values():
            feed.close()

    def report_error(self, where: str, **fields: object) -> None:
        """Log the exception being handled with its traceback, and count it."""
        self.errors += 1
        logger.error(event("error", where=where, **fields, trace=traceback.format_exc()))

    def _work_aside(self) -> None:
        while (work := self._side.get()) is not None:
            work()

    def _offer(self, subject: str, handler: Callable[[Any], None], argument: Any) -> None:
        self.queue.offer(subject, handler, argument)

    def _schedule(self, delay_s: float, period_s: float, action: Callable[[], None]) -> Handle:
        """The handle's own closing is what cancels: `run` asks it."""
        handle = Handle(_nothing)
        heapq.heappush(self._timers, (time.monotonic() + delay_s, next(self._order), period_s, action, handle))
        return handle

    def _step(self, longest_s: float = 1.0) -> None:
        wait = min(longest_s, self._timers[0][0] - time.monotonic()) if self._timers else longest_s
        task = self.queue.take(wait)
        if task is not None:
            self._do(task)
        now = time.monotonic()
        while self._timers and self._timers[0][0] <= now:
            _, _, period_s, action, handle = heapq.heappop(self._timers)
            if handle.closed:
                continue
            self._do(Task(_call, action))
            if period_s > 0.0:
                heapq.heappush(self._timers, (now + period_s, next(self._order), period_s, action, handle))

    def _do(self, task: Task) -> None:
        try:
            task.action(task.argument)
        except Exception:  # noqa: BLE001 - the loop serves other sessions too
            self.report_error(getattr(task.action, "__qualname__", "task"))

    def _tick_receivers(self) -> None:
        now = time.monotonic()
        self._receivers = {receiver for receiver in self._receivers if not receiver.closed}
        for receiver in self._receivers:
            receiver.tick(now)


def _call(action: Callable[[], None]) -> None:
    action()


def _nothing(_: object = None) -> None:
    """Only wakes the loop."""
