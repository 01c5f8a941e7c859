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
    process = subprocess.Popen(
        [sys.executable, "-c", WAITING], env={**os.environ, **(environment or {})}, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "up\n"
    return process


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_sets_the_event(number):
    process = start()
    process.send_signal(number)
    assert process.communicate(timeout=10) == ("stopped\n", None)
    assert process.returncode == 0


def test_a_child_without_its_supervisor_ends():
    process = start({SUPERVISOR_VARIABLE: "1"})
    assert process.communicate(timeout=10) == ("stopped\n", None)
