"""Takes pictures of pages for the READMEs: opens one, waits until it shows what it is about, and keeps it."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from selenium.common.exceptions import TimeoutException
from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

from services.cli.console import err, out

PATIENCE_S = 120
WIDTH, HEIGHT = 1366, 768
LIVE_S = 9.0
"""s that a live page is left alone, so that its curves are full."""
STILL_S = 1.5


@dataclass(frozen=True)
class Camera:
    """Somebody with a browser at the gateway at `url`, who puts pictures into a folder."""

    page: Chrome
    url: str
    folder: Path
    missing: list[str] = field(default_factory=list)
    """Pictures whose page never showed what it is about."""

    def take(self, name: str, path: str, ready: Callable[[], bool], height: int = HEIGHT) -> None:
        """A picture of a page once `ready`; noted as missing when it never is."""
        size = {"width": WIDTH, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.page.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        self.page.get("about:blank")
        self.page.get(self.url + path)
        self._when(ready, name, LIVE_S if name.startswith("live") else STILL_S)

    def keep(self, name: str, picture: bytes) -> None:
        """Write a picture and say so."""
        path = self.folder / f"{name}.png"
        path.write_bytes(picture)
        out.print(f"  {path}  {len(picture) // 1000} kB")

    def again(self, name: str, ready: Callable[[], bool]) -> None:
        """A picture of the page that is open, which something was done to."""
        self._when(ready, name, STILL_S)

    def _when(self, ready: Callable[[], bool], name: str, settle_s: float) -> None:
        try:
            self.wait(ready, name)
            time.sleep(settle_s)
            self.wait(ready, f"{name}, still")
        except TimeoutException:
            self.missing.append(name)
            err.print(f"  no picture of {name}: the page did not show what it is about")
            return
        self.keep(name, self.page.get_screenshot_as_png())

    def press(self, selector: str) -> None:
        """Click on something."""
        self.page.find_element(By.CSS_SELECTOR, selector).click()

    def wait(self, ready: Callable[[], bool], what: str) -> None:
        """Until something is shown. Raises TimeoutException."""
        WebDriverWait(self.page, PATIENCE_S).until(lambda _: ready(), what)

    def shown(self, selector: str, text: str) -> bool:
        """Whether any such element has the text in it."""
        return any(text in each.text for each in self.page.find_elements(By.CSS_SELECTOR, selector))

    def is_live(self) -> bool:
        """Whether a session's page is live and none of its numbers old."""
        grey = self.page.find_elements(By.CSS_SELECTOR, "td.stale")
        return self.shown(".session-head .chip", "Live") and not any(each.is_displayed() for each in grey)

    def is_finished(self) -> bool:
        """Whether the page of a session says that it is over."""
        return self.shown(".session-head .chip", "Finished")
