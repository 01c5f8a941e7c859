"""How the tests share several processes (`pytest -n 2 --dist loadscope --no-loadscope-reorder`).

What starts real processes and browsers goes to one of them, one after the other: two such tests at once would only
measure how busy the machine is. Everything else goes file by file, so that walks and estimates that a file keeps for
its tests are made once.
"""

import subprocess
import sys

import pytest
from xdist.scheduler import LoadScopeScheduling

WARM_UPS = (
    "from services.estimation.lower_body.warm_up import warm_up; warm_up()",
    "from services.estimation.knee.warm_up import warm_up; warm_up()",
)
"""The two halves of what takes long to compile where nothing is compiled yet, each in a process of its own."""


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_setupnodes() -> None:
    """Compile before the processes start: each of them would compile the same."""
    running = [subprocess.Popen([sys.executable, "-c", text]) for text in WARM_UPS]
    assert [child.wait() for child in running] == [0] * len(running), "the filters do not compile"


SYSTEM = "tests/system/"


class OneAtATime(LoadScopeScheduling):
    """What starts real processes is one piece of work, every other file is one, too."""

    def _split_scope(self, nodeid: str) -> str:
        return SYSTEM if nodeid.startswith(SYSTEM) else nodeid.partition("::")[0]


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: object) -> OneAtATime:
    """By place, not by marks: those do not reach the scheduler with every version of pytest."""
    return OneAtATime(config, log)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """In one of several processes: real processes first, as they take longest and mostly wait."""
    if hasattr(config, "workerinput"):
        items.sort(key=lambda item: not item.nodeid.startswith(SYSTEM))
