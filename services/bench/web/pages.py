"""The live page in Chromium with WebGL in software: frames, first paint, what is loaded and from where."""

import gzip
import time
import urllib.request
from dataclasses import dataclass
from urllib.parse import urlsplit

from selenium.webdriver import Chrome

from services.bench.web.site import Site
from services.cli import browser as browsers

COUNT_FRAMES = """
const [seconds, done] = arguments; let frames = 0; const from = performance.now();
const tick = (now) => { frames += 1;
  if (now - from < seconds * 1000) requestAnimationFrame(tick); else done(frames / ((now - from) / 1000)); };
requestAnimationFrame(tick);"""
LOADED = """return performance.getEntriesByType("resource")
  .filter((each) => ["script", "link", "css", "img", "other"].includes(each.initiatorType)).map((each) => each.name);"""
PAINTED = 'return performance.getEntriesByName("first-contentful-paint")[0]?.startTime ?? null;'
PATIENCE_S = 60.0
SETTLE_S = 3.0


@dataclass(frozen=True)
class Page:
    """What the browser told. `fps` of the live page; `first_paint_s` and `gzip_kb` of the first page of all, `live_kb`
    with the live page in addition.
    """

    fps: float
    first_paint_s: float
    gzip_kb: float
    live_kb: float
    foreign_hosts: int


def look(site: Site, seconds: float) -> Page:
    """Open the floor as at the first time, then a live session."""
    with browsers.open_browser() as browser:
        browser.set_script_timeout(seconds + PATIENCE_S)
        browsers.admit(browser, site.door)
        browser.get(site.door.url)
        painted_s = _first_paint_s(browser)
        time.sleep(SETTLE_S)
        first = {site.door.url + "/", *browser.execute_script(LOADED)}
        browser.get(f"{site.door.url}/#/sessions/{site.sessions[0]}")
        _wait_for_canvas(browser)
        fps = float(browser.execute_async_script(COUNT_FRAMES, seconds))
        later = first | set(browser.execute_script(LOADED))
        hosts = browsers.hosts_asked(browser)
    ours = urlsplit(site.door.url).netloc
    return Page(fps, painted_s, _gzip_kb(first), _gzip_kb(later), len(hosts - {ours}))


def _first_paint_s(browser: Chrome) -> float:
    end_s = time.monotonic() + PATIENCE_S
    while (painted_ms := browser.execute_script(PAINTED)) is None:
        if time.monotonic() > end_s:
            raise TimeoutError("the page was never painted")
        time.sleep(0.05)
    return float(painted_ms) / 1000


def _wait_for_canvas(browser: Chrome) -> None:
    end_s = time.monotonic() + PATIENCE_S
    while not browser.execute_script("return document.querySelectorAll('canvas').length"):
        if time.monotonic() > end_s:
            raise TimeoutError("the live page drew nothing")
        time.sleep(0.1)


def _gzip_kb(addresses: set[str]) -> float:
    """kB of pages, scripts, styles and pictures as a compressing server would send them; the level that they use."""
    files = [address for address in addresses if "/v1/" not in address]
    return sum(len(gzip.compress(_read(address), 6)) for address in files) / 1000


def _read(address: str) -> bytes:
    with urllib.request.urlopen(address, timeout=PATIENCE_S) as answer:
        return bytes(answer.read())
