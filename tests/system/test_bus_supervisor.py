"""The supervisor with real services as children."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from services.bus.router import RouterUnavailable, open_router
from services.bus.settings import BusSettings
from services.cli.supervisor import NotReady, Supervisor
from tests.system.stage import wait_until

pytestmark = pytest.mark.system

NODES = ["metrics", "segmentation"]
FREE = BusSettings(router="tcp/127.0.0.1:0", site="test")
STACK = """
import sys
from services.bus.settings import BusSettings
from services.cli.supervisor import Supervisor
with Supervisor(sys.argv[1:], BusSettings(router="tcp/127.0.0.1:0", site="test"), output=lambda line: print(line, flush=True)) as stack:
    stack.wait_until_ready(30)
    print("ready", *[stack.pid(name) for name in sys.argv[1:]], flush=True)
    stack.run()
print("stopped", flush=True)
"""  # noqa: E501


def is_running(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return "zombie" not in Path(f"/proc/{pid}/status").read_text()


def start_stack(*services: str) -> tuple[subprocess.Popen[str], list[int]]:
    """A supervisor in a process of its own, and its children's process ids once they are ready."""
    stack = subprocess.Popen([sys.executable, "-c", STACK, *services], stdout=subprocess.PIPE, text=True)
    assert stack.stdout is not None
    for line in stack.stdout:
        if line.startswith("ready"):
            return stack, [int(word) for word in line.split()[1:]]
    raise AssertionError("never ready")


def test_children_come_back_and_stop_in_order():
    lines: list[str] = []
    waited: list[list[str]] = []
    with Supervisor(NODES, FREE, output=lines.append) as supervisor:
        supervisor.wait_until_ready(30.0, lambda missing, _compiling: waited.append(missing))
        assert waited[0] == NODES, "whoever starts it is told who is waited for"
        first = supervisor.pid("segmentation")
        supervisor.kill("segmentation")
        assert not is_running(first)
        supervisor.wait_until_ready(30.0)
        assert supervisor.pid("segmentation") != first
        assert (supervisor.restarts("segmentation"), supervisor.restarts("metrics")) == (1, 0)
        pids = [supervisor.pid(name) for name in NODES]
    assert not any(is_running(pid) for pid in pids)
    stopped = [line.split(" | ")[0].strip() for line in lines if "event=stopped" in line]
    assert stopped == ["segmentation", "metrics"]
    assert any("event=child_ended service=segmentation status=-9" in line for line in lines)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_stops_everything(number: signal.Signals):
    stack, pids = start_stack("metrics")
    stack.send_signal(number)
    out, _ = stack.communicate(timeout=60)
    # The children's last words are passed on by threads and may come after it.
    assert "stopped" in out.splitlines()
    assert stack.returncode == 0
    assert not any(is_running(pid) for pid in pids)


def test_children_do_not_outlive_a_supervisor_that_was_killed():
    stack, pids = start_stack("metrics")
    stack.kill()
    stack.communicate(timeout=60)
    wait_until(lambda: not any(is_running(pid) for pid in pids))


def test_a_taken_port_is_named_with_what_to_do():
    with open_router(FREE) as router, pytest.raises(RouterUnavailable, match="AMBULA_ROUTER"):
        Supervisor(NODES, BusSettings(router=router.endpoint)).__enter__()


def test_a_service_that_never_comes_up_is_named_with_its_last_words():
    lines: list[str] = []
    with Supervisor(["no_such_service"], FREE, output=lines.append) as supervisor:
        with pytest.raises(NotReady, match=r"no_such_service.*\n.*No module named"):
            supervisor.wait_until_ready(2.0)
        assert 1 <= supervisor.restarts("no_such_service") <= 6


def test_a_child_that_will_not_stop_is_killed(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("services.cli.supervisor.STOP_PATIENCE_S", 0.5)
    with Supervisor(["metrics"], FREE, output=lambda _: None) as supervisor:
        supervisor.wait_until_ready(30.0)
        pid = supervisor.pid("metrics")
        os.kill(pid, signal.SIGSTOP)
        begun = time.monotonic()
    assert not is_running(pid)
    assert time.monotonic() - begun < 10.0


def test_run_ends_after_the_time_given():
    with Supervisor([], FREE) as supervisor:
        supervisor.wait_until_ready(1.0)
        supervisor.run(0.2)
