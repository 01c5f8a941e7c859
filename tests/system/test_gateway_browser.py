"""A person at the page: real services, a synthetic walk, a real browser."""

import json
import os
import socket
import time
import urllib.request
from dataclasses import dataclass
from pathlib import Path

import pytest
from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select, WebDriverWait

from services.bus.settings import BusSettings
from services.cli import browser as browsers
from services.cli.supervisor import Supervisor
from services.gateway.settings import DIST

pytestmark = [
    pytest.mark.system,
    pytest.mark.browser,
    pytest.mark.skipif(browsers.absent() is not None, reason=f"no browser: {browsers.absent()}"),
    pytest.mark.skipif(not (DIST / "index.html").exists(), reason="the pages are not built: run `make web`"),
]

SERVICES = ["archive", "estimation", "segmentation", "metrics", "gateway", "ingest"]
PATIENCE_S = 90

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


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return listener.getsockname()[1]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The address of a running floor."""
    port = free_port()
    environment = {
        "AMBULA_HTTP_HOST": "127.0.0.1",
        "AMBULA_HTTP_PORT": str(port),
        "AMBULA_DATA_DIR": str(tmp_path_factory.mktemp("recordings")),
        "AMBULA_DATABASE": "",
    }
    settings = BusSettings(router=f"tcp/127.0.0.1:{free_port()}")
    with Supervisor(SERVICES, settings, environment=environment) as supervisor:
        supervisor.wait_until_ready(timeout_s=180)
        yield Site(f"http://127.0.0.1:{port}", supervisor)


@dataclass
class Site:
    url: str
    supervisor: Supervisor


@pytest.fixture
def page():
    with browsers.open_browser() as page:
        yield page


def wait(page: Chrome, condition, what: str):
    return WebDriverWait(page, PATIENCE_S, poll_frequency=0.2).until(lambda _: condition(), what)


def text(page: Chrome, selector: str) -> str:
    found = page.find_elements(By.CSS_SELECTOR, selector)
    return found[0].text if found else ""


def start(page: Chrome, url: str, kind: str = "Walk, comfortable speed") -> None:
    """As a person would: the button, a source, Start."""
    page.get(url)
    page.find_element(By.ID, "start").click()
    source = page.find_element(By.ID, "source")
    wait(page, lambda: kind in source.text, "the sources are offered")
    Select(source).select_by_visible_text(kind)
    page.find_element(By.CSS_SELECTOR, "dialog button[type=submit]").click()
    wait(page, lambda: "#/sessions/" in page.current_url, "the session opens")


def keep(page: Chrome, name: str) -> None:
    """A picture for whoever wants to look: AMBULA_SCREENSHOTS names the folder."""
    folder = os.environ.get("AMBULA_SCREENSHOTS")
    if folder:
        page.save_screenshot(str(Path(folder) / f"{name}.png"))


def colours(page: Chrome, selector: str) -> int:
    picture = page.find_element(By.CSS_SELECTOR, selector).screenshot_as_base64
    return page.execute_async_script(COLOURS, picture)


def numbers(page: Chrome) -> list[str]:
    return [cell.text for cell in page.find_elements(By.CSS_SELECTOR, ".numbers td")]


def test_a_session_started_on_the_page_walks_fills_the_table_and_ends_in_a_report(site, page):
    start(page, site.url)
    wait(page, lambda: text(page, ".session-head .chip") == "Live", "the session is live")
    wait(page, lambda: all(cell != "–" for cell in numbers(page)), "both sides have strides")
    assert len(numbers(page)) == 8

    assert colours(page, ".stage canvas") > 200, "the skeleton's canvas is blank"
    assert all(colours(page, f".chart-panel:nth-child({place}) .chart") > 20 for place in (1, 2))

    seen = set()
    wait(page, lambda: seen.add(text(page, ".chart-panel b.left")) or len(seen) > 5, "the knee moves")
    first = page.find_element(By.CSS_SELECTOR, ".stage canvas").screenshot_as_base64
    wait(
        page,
        lambda: page.find_element(By.CSS_SELECTOR, ".stage canvas").screenshot_as_base64 != first,
        "the skeleton moves",
    )
    sensors = page.find_elements(By.CSS_SELECTOR, ".sensors .chip")
    assert [chip.text for chip in sensors] == ["Good"] * 5
    keep(page, "live")

    page.find_element(By.CSS_SELECTOR, "button.danger").click()
    wait(page, lambda: text(page, ".session-head .chip") == "Finished", "the session ends")
    wait(page, lambda: len(page.find_elements(By.CSS_SELECTOR, ".chart.mean canvas")) == 2, "the mean curves")
    wait(page, lambda: "m/s" in text(page, ".tiles"), "the metrics")
    keep(page, "report")
    wait(page, lambda: page.refresh() or "raw" in text(page, ".files"), "the recording can be fetched")

    assert browsers.complaints(page) == []
    assert browsers.hosts_asked(page) == {site.url.removeprefix("http://")}


def test_a_lost_gateway_greys_the_numbers_and_comes_back_by_itself(site, page):
    start(page, site.url)
    wait(page, lambda: text(page, ".session-head .chip") == "Live", "the session is live")
    site.supervisor.kill("gateway")
    wait(page, lambda: text(page, ".session-head .chip").startswith("Delayed ("), "the delay is told")
    assert "stale" in page.find_element(By.CSS_SELECTOR, ".numbers").get_attribute("class")
    assert "stale" in page.find_element(By.CSS_SELECTOR, ".stage").get_attribute("class")
    assert "lost" in text(page, "#connection")
    keep(page, "delayed")
    wait(page, lambda: text(page, ".session-head .chip") == "Live", "live again without a reload")


def test_with_reduced_motion_the_body_is_drawn_on_paper(site):
    with browsers.open_browser(1366, 768, "--force-prefers-reduced-motion") as page:
        start(page, site.url, "Walk, slow")
        wait(page, lambda: text(page, ".session-head .chip") == "Live", "the session is live")
        lines = wait(page, lambda: page.find_elements(By.CSS_SELECTOR, ".stage svg line"), "the figure is drawn")
        places = set()
        wait(page, lambda: places.add(lines[-1].get_attribute("y2")) or len(places) > 3, "the figure moves")
        assert page.find_elements(By.CSS_SELECTOR, ".stage canvas") == []
        assert browsers.complaints(page) == []


def test_the_page_of_the_api_works_without_the_internet(site, page):
    page.get(f"{site.url}/docs")
    wait(page, lambda: "/v1/sessions" in text(page, "#api"), "the API is shown")
    time.sleep(1.0)
    keep(page, "docs")
    assert browsers.complaints(page) == []
    assert browsers.hosts_asked(page) == {site.url.removeprefix("http://")}


def begin(url: str, source: str) -> str:
    """A session asked for by REST; its id."""
    body = json.dumps({"source": source}).encode()
    request = urllib.request.Request(f"{url}/v1/sessions", body, {"Content-Type": "application/json"})
    with urllib.request.urlopen(request, timeout=30) as answer:
        return str(json.load(answer)["id"])


def test_the_operator_marks_standing_and_is_told_when_it_was_none(site, page):
    """The walker stands for long, is marked, walks off, and is marked again while it walks."""
    session = begin(site.url, "synthetic:walk?standing=25&duration=120&seed=5")
    page.get(f"{site.url}/#/sessions/{session}")
    wait(page, lambda: "walk a few steps" in text(page, ".session-head .chip").lower(), "standing is found")
    time.sleep(3.0)
    page.find_element(By.CSS_SELECTOR, "button.mark").click()
    wait(page, lambda: text(page, ".session-head + .banner") == "Standing taken as marked", "the mark is taken")
    keep(page, "marked")
    wait(page, lambda: text(page, ".session-head .chip") == "Live", "the session is live")
    page.find_element(By.CSS_SELECTOR, "button.mark").click()
    wait(
        page, lambda: text(page, ".session-head + .banner").startswith("Not taken as standing: "), "the mark is refused"
    )
    assert text(page, ".session-head + .banner").endswith(" moved")
    keep(page, "mark-refused")
    wait(page, lambda: text(page, ".session-head + .banner") == "", "the notice goes by itself")
    assert browsers.complaints(page) == []
