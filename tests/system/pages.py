"""What browser tests share: a running floor, and the hands and eyes of a person at its page."""

import contextlib
import os
import socket
import urllib.error
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from selenium.common.exceptions import StaleElementReferenceException
from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select, WebDriverWait

from services.bus.settings import BusSettings
from services.cli import browser as browsers
from services.cli.door import Door
from services.cli.supervisor import Supervisor
from services.gateway.settings import DIST

NEEDED = [
    pytest.mark.system,
    pytest.mark.browser,
    pytest.mark.skipif(browsers.absent() is not None, reason=f"no browser: {browsers.absent()}"),
    pytest.mark.skipif(not (DIST / "index.html").exists(), reason="the pages are not built: run `make web`"),
]

SERVICES = ["archive", "estimation", "segmentation", "metrics", "gateway", "ingest"]
PATIENCE_S = 90
AS_SOURCE = "As the source says"

COLOURS = """
const done = arguments[arguments.length - 1];
const picture = new Image();
picture.onload = () => {
  const sheet = document.createElement("canvas");
  sheet.width = picture.width;
  sheet.height = picture.height;
  const pen = sheet.getContext("2d");
  pen.drawImage(picture, 0, 0);
  const { data } = pen.getImageData(0, 0, sheet.width, sheet.height);
  const seen = new Set();
  for (let i = 0; i < data.length; i += 4) seen.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
  done(seen.size);
};
picture.src = "data:image/png;base64," + arguments[0];
"""


@dataclass
class Site:
    """A running floor: where its page is, and who runs its services."""

    url: str
    supervisor: Supervisor
    door: Door


@contextmanager
def open_site(recordings: Path, services: Sequence[str] = SERVICES) -> Iterator[Site]:
    """Services on free ports, all of them if no others are named."""
    port = free_port()
    environment = {
        "AMBULA_HTTP_HOST": "127.0.0.1",
        "AMBULA_HTTP_PORT": str(port),
        "AMBULA_DATA_DIR": str(recordings),
        "AMBULA_DATABASE": "",
    }
    settings = BusSettings(router=f"tcp/127.0.0.1:{free_port()}")
    with Supervisor(services, settings, environment=environment) as supervisor:
        supervisor.wait_until_ready(timeout_s=180)
        url = f"http://127.0.0.1:{port}"
        yield Site(url, supervisor, Door.of_first_administrator(url, recordings, PATIENCE_S))


def end_all(door: Door) -> None:
    """Stop whatever is still live."""
    for session in door.ask("sessions?state=live")["items"]:
        # It may end by itself in between.
        with contextlib.suppress(urllib.error.HTTPError):
            door.ask(f"sessions/{session['id']}/stop", {})


def free_port() -> int:
    """A port of loopback that nobody listens on."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


def wait(page: Chrome, condition: Callable[[], Any], what: str) -> Any:
    """Poll until the condition holds; its value. What was drawn anew while it was looked at is looked at again."""
    waiting = WebDriverWait(page, PATIENCE_S, poll_frequency=0.2, ignored_exceptions=[StaleElementReferenceException])
    return waiting.until(lambda _: condition(), what)


def text(page: Chrome, selector: str) -> str:
    """Text of the first such element; empty when there is none."""
    found = page.find_elements(By.CSS_SELECTOR, selector)
    return found[0].text if found else ""


def onward(page: Chrome, to: str) -> None:
    """Next, or Begin; `to` is the heading of the step that follows."""
    page.find_element(By.CSS_SELECTOR, ".start-step button[type=submit]").click()
    wait(page, lambda: text(page, ".start-step h2") == to, f"the step: {to}")


def choose_protocol(page: Chrome, task: str = AS_SOURCE) -> None:
    """The button, no patient yet, then what will be done."""
    # The button is there for whoever may press it, which the page asks first.
    wait(page, lambda: page.find_element(By.ID, "start").is_displayed(), "a session may be started")
    page.find_element(By.ID, "start").click()
    wait(page, lambda: text(page, ".start-step h2") == "Whose session is it?", "the first step")
    onward(page, "What will be done?")
    page.find_element(By.XPATH, f"//fieldset//label[normalize-space()='{task}']").click()


def choose_source(page: Chrome, kind: str, task: str = AS_SOURCE) -> None:
    """All steps up to a source."""
    choose_protocol(page, task)
    choose_measuring(page, kind)


def choose_measuring(page: Chrome, kind: str) -> None:
    """From the protocol to a source."""
    onward(page, "What measures?")
    source = page.find_element(By.ID, "source")
    wait(page, lambda: kind in source.text, "the sources are offered")
    Select(source).select_by_visible_text(kind)


def confirm(page: Chrome) -> None:
    """Begin, and straight on to the live page."""
    onward(page, "Calibration")
    page.find_element(By.CSS_SELECTOR, ".start-step button[type=submit]").click()
    wait(page, lambda: "#/sessions/" in page.current_url, "the session opens")


def start(page: Chrome, url: str, kind: str = "Walk, comfortable speed", speed: str = "Real time") -> None:
    """As a person would: the button, a source, a speed, Begin."""
    page.get(url)
    wait(page, lambda: page.find_elements(By.ID, "start"), "the page is there")
    choose_source(page, kind)
    Select(page.find_element(By.ID, "speed")).select_by_visible_text(speed)
    confirm(page)


def read(page: Chrome, choice: str) -> None:
    """Choose a reading level or a language of a report by its words."""
    option = f"//fieldset//label[normalize-space()='{choice}']"
    wait(page, lambda: page.find_elements(By.XPATH, option), f"{choice} can be chosen")
    page.find_element(By.XPATH, option).click()


def part(page: Chrome, name: str) -> None:
    """Open a part of a session that is over by its word, e.g. Replay."""
    link = f"//nav[contains(@class, 'parts-nav')]/a[normalize-space()='{name}']"
    wait(page, lambda: page.find_elements(By.XPATH, link), f"{name} is offered")
    page.find_element(By.XPATH, link).click()
    current = f"{link}[@aria-current='page']"
    wait(page, lambda: page.find_elements(By.XPATH, current), f"{name} is opened")


def keep(page: Chrome, name: str) -> None:
    """A picture for whoever wants to look: AMBULA_SCREENSHOTS names the folder."""
    folder = os.environ.get("AMBULA_SCREENSHOTS")
    if folder:
        page.save_screenshot(str(Path(folder) / f"{name}.png"))


def colours(page: Chrome, selector: str) -> int:
    """Number of different colours of an element as it is seen."""
    picture = page.find_element(By.CSS_SELECTOR, selector).screenshot_as_base64
    return int(page.execute_async_script(COLOURS, picture))


def begin(door: Door, source: str, speed: float | None = 1.0) -> str:
    """A session asked for by REST; its id."""
    return str(door.ask("sessions", {"source": source, "speed": speed})["id"])


def shown(page: Chrome, selector: str) -> list[str]:
    """Texts of those elements that can be seen."""
    return [each.text for each in page.find_elements(By.CSS_SELECTOR, selector) if each.is_displayed()]


def seen(page: Chrome, selector: str, count: int, what: str) -> None:
    """Wait until the text of an element has been that many different ones."""
    texts = set()
    wait(page, lambda: texts.add(text(page, selector)) or len(texts) >= count, what)


def live(page: Chrome) -> bool:
    """Whether the session on the page is."""
    return text(page, ".session-head .chip") == "Live"
