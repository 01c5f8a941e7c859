"""Ctrl-C in the middle of a search."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.system

PROC = Path("/proc/self/task")


def children(pid: int) -> set[int]:
    return {int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()}


def is_running(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


@pytest.mark.skipif(not PROC.exists(), reason="asks /proc who is whose child")
def test_ctrl_c_ends_the_search_and_its_processes_and_writes_nothing(tmp_path: Path) -> None:
    file = tmp_path / "tables.py"
    command = [sys.executable, "-m", "services.cli", "tune", "--task", "3", "--way", "ours", "--out", str(file)]
    search = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
    try:
        seen, begun = set[int](), time.monotonic()
        while len(seen) < 3 and time.monotonic() - begun < 120:  # two workers and who watches over their memory
            assert search.poll() is None, search.stderr.read().decode()
            seen = children(search.pid)
            time.sleep(0.1)
        assert len(seen) == 3
        time.sleep(1.0)
        os.killpg(search.pid, signal.SIGINT)
        _, said = search.communicate(timeout=120)
    finally:
        if search.poll() is None:
            os.killpg(search.pid, signal.SIGKILL)
    assert search.returncode == 130
    assert "stopped" in said.decode()
    assert "Traceback" not in said.decode()
    assert not file.exists()
    ended = time.monotonic()
    while any(map(is_running, seen)) and time.monotonic() - ended < 20:  # who watched over memory leaves last
        time.sleep(0.1)
    assert not [pid for pid in seen if is_running(pid)]
