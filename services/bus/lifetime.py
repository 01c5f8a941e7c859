"""When a process has to end: told by a signal, or left alone by the supervisor that started it."""

import os
import queue
import signal
import threading
from collections.abc import Callable
from types import FrameType

SUPERVISOR_VARIABLE = "AMBULA_SUPERVISOR"
"""Process id of the supervisor; its children end when it is gone."""
LOOK_S = 0.5


def call_on_stop(action: Callable[[], None]) -> None:
    """Call `action` once, on a thread of its own, at SIGTERM, SIGINT or the supervisor's end.

    A signal handler interrupts the main thread anywhere, even while it holds the lock that the action needs; so
    the handler only puts into a queue that allows for that.
    """
    told: queue.SimpleQueue[None] = queue.SimpleQueue()

    def handle(_number: int, _frame: FrameType | None) -> None:
        told.put(None)

    def wait() -> None:
        while not _is_orphan():
            try:
                told.get(timeout=LOOK_S)
                break
            except queue.Empty:
                continue
        action()

    signal.signal(signal.SIGTERM, handle)
    signal.signal(signal.SIGINT, handle)
    threading.Thread(target=wait, name="lifetime", daemon=True).start()


def stop_event() -> threading.Event:
    """An event that is set when the process has to end."""
    stop = threading.Event()
    call_on_stop(stop.set)
    return stop


def _is_orphan() -> bool:
    """A child whose parent died has another parent."""
    supervisor = os.environ.get(SUPERVISOR_VARIABLE)
    return supervisor is not None and os.getppid() != int(supervisor)
