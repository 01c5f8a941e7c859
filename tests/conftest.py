"""How the tests share several processes (`pytest -n 2 --dist loadgroup`).

What starts real processes and browsers goes to one of them, one after the other: two such tests at once would only
measure how busy the machine is. Everything else goes file by file, so that walks and estimates that a file keeps for
its tests are made once.
"""

import subprocess
import sys

import pytest

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


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """In one of several processes: real processes first, as they take longest and mostly wait."""
    if not hasattr(config, "workerinput"):
        return
    for item in items:
        group = "system" if item.get_closest_marker("system") else item.path.as_posix()
        item.add_marker(pytest.mark.xdist_group(group))
    items.sort(key=lambda item: item.get_closest_marker("system") is None)
