"""Processes that are told to end, end."""

import os
import signal
import subprocess
import sys

import pytest

from services.bus.lifetime import SUPERVISOR_VARIABLE

WAITING = """
from services.bus.lifetime import stop_event
stop = stop_event()
print("up", flush=True)
stop.wait(20)
print("stopped" if stop.is_set() else "timed out", flush=True)
"""


def start(environment: dict[str, str] | None = None) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", WAITING], env={**os.environ, **(environment or {})}, stdout=subprocess.PIPE, text=True
    )


def ending(process: subprocess.Popen[str]) -> str:
    """The rest of what the process says, once it has ended by itself."""
    out, _ = process.communicate(timeout=10)
    assert process.returncode == 0
    return out


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_sets_the_event(number):
    process = start()
    assert process.stdout is not None
    assert process.stdout.readline() == "up\n"
    process.send_signal(number)
    assert ending(process) == "stopped\n"


def test_a_child_without_its_supervisor_ends():
    assert ending(start({SUPERVISOR_VARIABLE: "1"})) == "up\nstopped\n"
