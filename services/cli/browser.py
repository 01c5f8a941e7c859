"""A headless Chromium, as the browser test and the screenshots use it. Needs the development dependencies."""

import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit

from selenium.webdriver import Chrome, ChromeOptions
from selenium.webdriver.chrome.service import Service

from services.cli.door import Door

FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--force-color-profile=srgb",
    # WebGL in software; Chromium 144 and newer refuse it without both.
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
)


def absent() -> str | None:
    """Why no browser can be opened; None when one can."""
    missing = [name for name in ("chromium", "chromedriver") if shutil.which(name) is None]
    return f"{' and '.join(missing)} not installed" if missing else None


@contextmanager
def open_browser(width: int = 1366, height: int = 768, *flags: str) -> Iterator[Chrome]:
    """A browser whose pages have exactly that size; extra command line flags may follow."""
    options = ChromeOptions()
    options.binary_location = shutil.which("chromium") or ""
    for flag in (*FLAGS, *flags):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    browser = Chrome(options=options, service=Service(shutil.which("chromedriver") or ""))
    try:
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
        yield browser
    finally:
        browser.quit()


def admit(browser: Chrome, door: Door) -> None:
    """Give the browser somebody's sign-in."""
    name, value = door.cookie
    cookie = {"name": name, "value": value, "url": door.url, "httpOnly": True, "sameSite": "Strict"}
    browser.execute_cdp_cmd("Network.setCookie", cookie)


def complaints(browser: Chrome) -> list[str]:
    """What the console has said at the level of warnings and errors since the last call."""
    entries = [entry for entry in _log(browser, "browser") if entry["level"] in ("WARNING", "SEVERE")]
    # Reading pixels back for a screenshot stalls a graphics card; the driver says so.
    return [entry["message"] for entry in entries if "GL Driver Message" not in entry["message"]]


def hosts_asked(browser: Chrome) -> set[str]:
    """Every host that a page has sent a request to since the last call; `data:` and `blob:` have none."""
    hosts = set()
    for entry in _log(browser, "performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            hosts.add(urlsplit(message["params"]["request"]["url"]).netloc)
        elif message["method"] == "Network.webSocketCreated":
            hosts.add(urlsplit(message["params"]["url"]).netloc)
    return hosts - {""}


def _log(browser: Chrome, kind: str) -> list[dict[str, Any]]:
    entries: list[dict[str, Any]] = browser.get_log(kind)  # type: ignore[no-untyped-call]
    return entries
