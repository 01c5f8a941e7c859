"""Pictures of the pages with the whole stack behind them: `python -m services.cli.screenshots [FOLDER]`."""

import socket
import sys
import tempfile
import time
from collections.abc import Callable
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
    def take(name: str, path: str, ready: Callable[[], bool]) -> None:
        page.get("about:blank")
        page.get(url + path)
        WebDriverWait(page, PATIENCE_S).until(lambda _: ready(), name)
        time.sleep(9.0 if name == "live" else 1.5)
        page.save_screenshot(str(folder / f"{name}.png"))
        out.print(f"  {folder / name}.png")

    def shown(selector: str, text: str) -> bool:
        return any(text in each.text for each in page.find_elements(By.CSS_SELECTOR, selector))

    with Bus.open(settings, "screenshots") as bus:
        finished = live.start_session(bus, SHORT, None).session
        walking = [live.start_session(bus, spec, 1.0).session for spec in (*LONG, *_recorded())]
    live_path, report_path = f"/#/sessions/{walking[0]}", f"/#/sessions/{finished}"
    take("sessions", "/", lambda: shown(".card .chip", "Live"))
    take("live", live_path, lambda: shown(".session-head .chip", "Live") and not shown(".numbers td", "–"))
    take("report", report_path, lambda: shown(".session-head .chip", "Finished") and shown(".files", "raw"))
    take("system", "/#/system", lambda: shown("tbody", "imu/"))
    take("api", "/docs", lambda: shown("#api", "/v1/sessions"))


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
