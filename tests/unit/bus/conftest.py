"""A router in this process and as many clients as a test needs."""

from collections.abc import Callable, Iterator

import pytest

from services.bus.connection import Bus
from services.bus.router import Router, open_router
from services.bus.settings import BusSettings


@pytest.fixture
def router() -> Iterator[Router]:
    """A router on a free port of loopback."""
    with open_router(BusSettings(router="tcp/127.0.0.1:0", site="test")) as router:
        yield router


@pytest.fixture
def connect(router: Router) -> Iterator[Callable[[str], Bus]]:
    """Opens a client of the router under a service's name."""
    opened: list[Bus] = []

    def open_bus(service: str = "test") -> Bus:
        opened.append(Bus.open(BusSettings(router=router.endpoint, site="test"), service))
        return opened[-1]

    yield open_bus
    for bus in opened:
        bus.close()


@pytest.fixture
def wait_until() -> Callable[..., None]:
    """Polls until a condition holds, and fails the test when it does not within ten seconds."""
    import time

    def wait(condition: Callable[[], object]) -> None:
        end = time.monotonic() + 10.0
        while not condition():
            assert time.monotonic() < end
            time.sleep(0.01)

    return wait
