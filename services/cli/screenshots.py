"""Pictures of the pages with the whole stack behind them: `python -m services.cli.screenshots [FOLDER]`."""

import socket
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

from services.bus.connection import Bus
from services.bus.settings import BusSettings
from services.cli import browser as browsers
from services.cli import live
from services.cli.console import err, out
from services.cli.supervisor import Supervisor
from services.ingest.errors import SourceError
from services.ingest.source import open_source

SERVICES = ["archive", "estimation", "segmentation", "metrics", "gateway", "ingest"]
SHORT = "synthetic:walk?speed=1.2&seed=4&duration=40"
"""Over soon, so that there is a report to show."""
LONG = ("synthetic:walk?speed=1.15&seed=1&duration=300", "synthetic:walk?speed=0.7&asymmetry=0.25&seed=2&duration=300")
RECORDED = "neura_s02_walk"
KNEE = "synthetic:walk?worn=1&speed=1.1&seed=4&duration=300"
EXERCISE = "synthetic:knee?seed=2&duration=300"
TIMED = "synthetic:tug?attempts=3&stroll=8&seed=4"
SQUATS = "synthetic:squat?person=2&repetitions=12"
BODY = "synthetic:squat?person=2&repetitions=100"
PATIENCE_S = 120


def main() -> int:
    """Exit code; the folder is the first argument, `out/screenshots` without one."""
    missing = browsers.absent()
    if missing is not None:
        err.print(f"no pictures: {missing}")
        return 1
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/screenshots")
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as data:
        port = _free_port()
        environment = {"AMBULA_HTTP_PORT": str(port), "AMBULA_DATA_DIR": data, "AMBULA_DATABASE": ""}
        settings = BusSettings(router=f"tcp/127.0.0.1:{_free_port()}")
        with Supervisor(SERVICES, settings, environment=environment) as stack, browsers.open_browser() as page:
            stack.wait_until_ready(timeout_s=180)
            _take_all(page, f"http://127.0.0.1:{port}", settings, folder)
    return 0


def _take_all(page: Chrome, url: str, settings: BusSettings, folder: Path) -> None:
    camera = _Camera(page, url, folder)
    live_now, finished, shown = camera.is_live, camera.is_finished, camera.shown
    with Bus.open(settings, "screenshots") as bus:
        walk, timed, squats = (live.start_session(bus, spec, None).session for spec in (SHORT, TIMED, SQUATS))
        now = (LONG[0], KNEE, EXERCISE, BODY, *LONG[1:], *_recorded())
        lower_body, knee, exercise, body, *_ = [live.start_session(bus, spec, 1.0).session for spec in now]
    camera.take("live_body", f"/#/sessions/{body}", lambda: live_now() and shown(".counter dd", "/min"))
    camera.take("live_knee", f"/#/sessions/{knee}", lambda: live_now() and shown(".knee-label", "°"))
    camera.take("live_exercise", f"/#/sessions/{exercise}", lambda: live_now() and shown(".counter dd", "/min"))
    camera.take("live", f"/#/sessions/{lower_body}", lambda: live_now() and not shown(".numbers td", "–"))
    camera.take("sessions", "/", lambda: shown(".card .chip", "Live"))
    camera.take("report", f"/#/sessions/{walk}", finished)
    camera.take("report_timed", f"/#/sessions/{timed}", lambda: finished() and shown("th", "Walk back"))
    camera.take("report_body", f"/#/sessions/{squats}", lambda: finished() and shown("th", "Knee flexion range"))
    camera.take("system", "/#/system", lambda: shown("tbody", "imu/"))
    camera.take("api", "/docs", lambda: shown("#api", "/v1/sessions"))


@dataclass(frozen=True)
class _Camera:
    page: Chrome
    url: str
    folder: Path

    def take(self, name: str, path: str, ready: Callable[[], bool]) -> None:
        self.page.get("about:blank")
        self.page.get(self.url + path)
        WebDriverWait(self.page, PATIENCE_S).until(lambda _: ready(), name)
        time.sleep(9.0 if name.startswith("live") else 1.5)
        WebDriverWait(self.page, PATIENCE_S).until(lambda _: ready(), f"{name}, still")
        self.page.save_screenshot(str(self.folder / f"{name}.png"))
        out.print(f"  {self.folder / name}.png")

    def shown(self, selector: str, text: str) -> bool:
        return any(text in each.text for each in self.page.find_elements(By.CSS_SELECTOR, selector))

    def is_live(self) -> bool:
        grey = self.page.find_elements(By.CSS_SELECTOR, "td.stale")
        return self.shown(".session-head .chip", "Live") and not any(each.is_displayed() for each in grey)

    def is_finished(self) -> bool:
        return self.shown(".session-head .chip", "Finished") and self.shown(".files", "raw")


def _recorded() -> list[str]:
    try:
        open_source(RECORDED)
    except SourceError:
        return []
    return [RECORDED]


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


if __name__ == "__main__":
    sys.exit(main())
