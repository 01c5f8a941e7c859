"""Ctrl-C where something has to be finished properly."""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def on_interrupt(action: Callable[[], None] | None) -> Iterator[None]:
    """The first Ctrl-C starts `action` on a thread instead of an exception; the next one is an exception again.

    None changes nothing, nor does another thread than the main one, to which no signal comes.
    """
    if action is None or threading.current_thread() is not threading.main_thread():
        yield
        return

    def start(_number: int, _frame: FrameType | None) -> None:
        signal.signal(signal.SIGINT, previous)
        threading.Thread(target=action, daemon=True).start()

    previous = signal.signal(signal.SIGINT, start)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, previous)
