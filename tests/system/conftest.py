"""Real processes over loopback: a router on a free port, services as children."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from selenium.webdriver import Chrome

from services.bus.router import Router, choose_endpoint, open_router
from services.bus.settings import BusSettings
from services.cli import browser as browsers
from tests.system import pages
from tests.system.stage import Processes


@pytest.fixture(scope="module")
def free_router() -> str:
    """An endpoint on loopback that nobody listens on."""
    return choose_endpoint("tcp/127.0.0.1:0")


@pytest.fixture
def router() -> Iterator[Router]:
    """A router in this process, on a free port of loopback."""
    with open_router(BusSettings(router="tcp/127.0.0.1:0", site="test")) as router:
        yield router


@pytest.fixture
def settings(router: Router) -> BusSettings:
    """Settings of a client of `router`."""
    return BusSettings(router=router.endpoint, site="test")


@pytest.fixture
def closing() -> Iterator[Callable[[Any], Any]]:
    """Registers something to be closed at the end of the test, last first."""
    things: list[Any] = []

    def register(thing: Any) -> Any:
        things.append(thing)
        return thing

    yield register
    for thing in reversed(things):
        thing.close()


@pytest.fixture
def processes(settings: BusSettings, tmp_path: Path) -> Iterator[Processes]:
    """Child processes with the router's address in their environment."""
    processes = Processes(settings, tmp_path)
    yield processes
    processes.close()


@pytest.fixture(scope="session")
def floor(tmp_path_factory: pytest.TempPathFactory) -> Iterator[pages.Site]:
    """A running floor with every service."""
    with pages.open_site(tmp_path_factory.mktemp("recordings")) as site:
        yield site


@pytest.fixture
def page() -> Iterator[Chrome]:
    """A browser."""
    with browsers.open_browser() as page:
        yield page


@pytest.fixture
def site(floor: pages.Site, page: Chrome) -> Iterator[pages.Site]:
    """A running floor without sessions, to which the browser has been admitted; those a test leaves behind would slow
    down the next."""
    browsers.admit(page, floor.door)
    yield floor
    pages.end_all(floor.door)
