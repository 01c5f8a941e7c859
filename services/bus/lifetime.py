"""When a process has to end: told by a signal, or left alone by the supervisor that started it."""

import os
import signal
import threading
import time
from collections.abc import Callable
from types import FrameType

SUPERVISOR_VARIABLE = "AMBULA_SUPERVISOR"
"""Process id of the supervisor; its children end when it is gone."""
LOOK_S = 0.5


def call_on_stop(action: Callable[[], None]) -> None:
    """Call `action` (quick, safe in a signal handler) on SIGTERM, SIGINT and the supervisor's end."""

    def handle(_number: int, _frame: FrameType | None) -> None:
        action()

    signal.signal(signal.SIGTERM, handle)
    signal.signal(signal.SIGINT, handle)
    supervisor = os.environ.get(SUPERVISOR_VARIABLE)
    if supervisor is not None:
        threading.Thread(target=_watch, args=(int(supervisor),), name="lifetime", daemon=True).start()


def stop_event() -> threading.Event:
    """An event that is set when the process has to end."""
    stop = threading.Event()
    call_on_stop(stop.set)
    return stop


def _watch(supervisor: int) -> None:
    """A child whose parent died has another parent."""
    while os.getppid() == supervisor:
        time.sleep(LOOK_S)
    os.kill(os.getpid(), signal.SIGTERM)
