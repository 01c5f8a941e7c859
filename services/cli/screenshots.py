"""Pictures of pages and reports, with the whole stack behind them: `python -m services.cli.screenshots [FOLDER]`."""

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
from services.cli import live, picture_visits
from services.cli.console import err, out
from services.cli.door import Door
from services.cli.supervisor import Supervisor
from services.ingest.errors import SourceError
from services.ingest.source import open_source
from services.report.content import Report
from services.report.press import press

SERVICES = ["archive", "estimation", "segmentation", "metrics", "gateway", "ingest"]
LONG = ("synthetic:walk?speed=1.15&seed=1&duration=300", "synthetic:walk?speed=0.7&asymmetry=0.25&seed=2&duration=300")
RECORDED = "neura_s02_walk"
KNEE = "synthetic:walk?worn=1&speed=1.1&seed=4&duration=300"
EXERCISE = "synthetic:knee?seed=2&duration=300"
TIMED = "synthetic:tug?attempts=3&stroll=8&seed=4"
SQUATS = "synthetic:squat?person=2&repetitions=12"
BODY = "synthetic:squat?person=2&repetitions=100"
SIX_MINUTES = "synthetic:six_minutes?rests=1&seed=6"
PATIENCE_S = 300
HEIGHT = 768
PAPER_PIXELS_PER_INCH = 100


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
            door = Door.of_first_administrator(f"http://127.0.0.1:{port}", Path(data))
            browsers.admit(page, door)
            camera = _Camera(page, door.url, folder)
            _take_patient(camera, door, Path(data))
            _take_sessions(camera, settings)
    return 0


def _take_patient(camera: "_Camera", door: Door, data: Path) -> None:
    patient = picture_visits.visits(door, data, PATIENCE_S)
    last = patient.sessions[-1]
    progress = f"/#/patients/{patient.code}"
    camera.take("progress", progress, lambda: camera.shown(".verdict", "real change"), height=1110)
    camera.take("report", f"/#/sessions/{last}", lambda: camera.shown(".sheet", "m/s"), height=1240)
    report = Report.model_validate(door.ask(f"sessions/{last}/report?language=en"))
    for number, picture in enumerate(press().pictures(report, PAPER_PIXELS_PER_INCH), start=1):
        camera.keep(f"report_page_{number}", picture)


def _take_sessions(camera: "_Camera", settings: BusSettings) -> None:
    live_now, finished, shown = camera.is_live, camera.is_finished, camera.shown
    with Bus.open(settings, "screenshots") as bus:
        timed, squats = (live.start_session(bus, spec, None).session for spec in (TIMED, SQUATS))
        now = (LONG[0], KNEE, EXERCISE, BODY, SIX_MINUTES, *LONG[1:], *_recorded())
        lower_body, knee, exercise, body, corridor, *_ = [live.start_session(bus, spec, 1.0).session for spec in now]
    camera.take("live_body", f"/#/sessions/{body}", lambda: live_now() and shown(".counter dd", "/min"))
    camera.take("live_knee", f"/#/sessions/{knee}", lambda: live_now() and shown(".knee-label", "°"))
    camera.take("live_exercise", f"/#/sessions/{exercise}", lambda: live_now() and shown(".counter dd", "/min"))
    camera.take("live", f"/#/sessions/{lower_body}", lambda: live_now() and not shown(".numbers td", "–"))
    camera.take("live_six_minutes", f"/#/sessions/{corridor}", lambda: live_now() and shown(".walk-strip dd", " m"))
    camera.take("sessions", "/", lambda: shown(".card .light", "Good"))
    camera.take("report_timed", f"/#/sessions/{timed}/curves", lambda: finished() and shown("th", "Walk back"))
    camera.take("report_body", f"/#/sessions/{squats}/curves", lambda: finished() and shown("th", "Knee flexion range"))
    camera.take("system", "/#/system", lambda: shown("tbody", "imu/"))
    camera.take("api", "/docs", lambda: shown("#api", "/v1/sessions"))


@dataclass(frozen=True)
class _Camera:
    page: Chrome
    url: str
    folder: Path

    def take(self, name: str, path: str, ready: Callable[[], bool], height: int = HEIGHT) -> None:
        self.page.execute_cdp_cmd(
            "Emulation.setDeviceMetricsOverride",
            {"width": 1366, "height": height, "deviceScaleFactor": 1, "mobile": False},
        )
        self.page.get("about:blank")
        self.page.get(self.url + path)
        WebDriverWait(self.page, PATIENCE_S).until(lambda _: ready(), name)
        time.sleep(9.0 if name.startswith("live") else 1.5)
        WebDriverWait(self.page, PATIENCE_S).until(lambda _: ready(), f"{name}, still")
        self.keep(name, self.page.get_screenshot_as_png())

    def keep(self, name: str, picture: bytes) -> None:
        path = self.folder / f"{name}.png"
        path.write_bytes(picture)
        out.print(f"  {path}  {len(picture) // 1000} kB")

    def remember(self, name: str, value: str) -> None:
        self.page.execute_script(f"localStorage.setItem('ambula.{name}', '{value}')")

    def shown(self, selector: str, text: str) -> bool:
        return any(text in each.text for each in self.page.find_elements(By.CSS_SELECTOR, selector))

    def is_live(self) -> bool:
        grey = self.page.find_elements(By.CSS_SELECTOR, "td.stale")
        return self.shown(".session-head .chip", "Live") and not any(each.is_displayed() for each in grey)

    def is_finished(self) -> bool:
        return self.shown(".session-head .chip", "Finished")


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
