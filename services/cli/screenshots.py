"""Pictures of pages and reports, with the whole stack behind them: `python -m services.cli.screenshots [FOLDER]`."""

import socket
import sys
import tempfile
from pathlib import Path
from typing import Any

from selenium.webdriver.common.by import By

from services.bus.settings import BusSettings
from services.cli import browser as browsers
from services.cli import picture_visits
from services.cli.camera import Camera
from services.cli.console import err
from services.cli.door import Door
from services.cli.supervisor import Supervisor
from services.report.content import Report
from services.report.press import press

SERVICES = ["archive", "estimation", "segmentation", "metrics", "gateway", "ingest"]
WALK = "synthetic:walk?speed=1.15&seed=1&duration=600"
KNEE = "synthetic:walk?worn=1&speed=1.1&seed=4&duration=600"
EXERCISE = "synthetic:knee?seed=2&duration=600"
BODY = "synthetic:squat?person=2&repetitions=200"
SIX_MINUTES = "synthetic:six_minutes?rests=1&seed=6"
BESIDE = (
    "synthetic:walk?speed=0.7&asymmetry=0.25&seed=2&duration=600",
    "synthetic:tug?attempts=20&stroll=8&seed=4",
    "synthetic:march?seed=8&duration=600",
)
TIMED = "synthetic:tug?attempts=3&stroll=8&seed=4"
SQUATS = "synthetic:squat?person=2&repetitions=12"
OTHERS = (
    {"year_of_birth": 1949, "sex": "male", "population": "parkinson"},
    {"year_of_birth": 1971, "sex": "female", "population": "knee_osteoarthritis", "paretic_side": "right"},
    {"year_of_birth": 1962, "population": "multiple_sclerosis", "paretic_side": "left"},
    {"year_of_birth": 1955, "sex": "male", "population": "stroke_subacute", "paretic_side": "right"},
)
PAPER_PIXELS_PER_INCH = 92
VISITS_S = 600
ONWARD = ".start-step button[type=submit]"


def main() -> int:
    """Exit code, 1 when a picture is missing; the folder is the first argument, `out/screenshots` without one."""
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
            camera = Camera(page, door.url, folder)
            camera.take("sign_in", "/", lambda: camera.shown("h1", "Sign in"))
            browsers.admit(page, door)
            _take_patient(camera, door, Path(data))
            _take_sessions(camera, door)
            _take_start(camera)
            _take_site(camera, door)
    return 1 if camera.missing else 0


def _take_patient(camera: Camera, door: Door, data: Path) -> None:
    """Somebody who came five times, among others."""
    patient = picture_visits.visits(door, data, VISITS_S)
    for facts in OTHERS:
        door.ask("patients", facts)
    last = patient.sessions[-1]
    shown = camera.shown
    camera.take("progress", f"/#/patients/{patient.code}", lambda: shown(".verdict", "real change"), height=1110)
    camera.take("patients", "/#/patients", lambda: shown(".chip", "real change"))
    camera.take("report", f"/#/sessions/{last}", lambda: shown(".sheet", "m/s"), height=1240)
    camera.take(
        "replay",
        f"/#/sessions/{last}/replay?t=48",
        lambda: shown(".numbers td", "0.") and not shown(".numbers td", "–"),
        height=900,
    )
    camera.take(
        "strides",
        f"/#/sessions/{last}/strides",
        lambda: bool(camera.page.find_elements(By.CSS_SELECTOR, "tbody tr:nth-child(5)")),
    )
    report = Report.model_validate(door.ask(f"sessions/{last}/report?language=en"))
    for number, picture in enumerate(press().pictures(report, PAPER_PIXELS_PER_INCH), start=1):
        camera.keep(f"report_page_{number}", picture)


def _take_sessions(camera: Camera, door: Door) -> None:
    """What runs now, and what has just been done."""
    live, over, shown = camera.is_live, camera.is_finished, camera.shown
    timed, squats = (_begin(door, source, None) for source in (TIMED, SQUATS))
    now = (WALK, KNEE, EXERCISE, BODY, SIX_MINUTES, *BESIDE)
    codes = [each["code"] for each in door.ask("roster")["items"]]
    walk, knee, exercise, body, corridor, *_ = (
        _begin(door, source, 1.0, code) for source, code in zip(now, [*codes, *[None] * len(now)], strict=False)
    )
    camera.take("live_body", f"/#/sessions/{body}", lambda: live() and shown(".counter dd", "/min"))
    camera.take("live_knee", f"/#/sessions/{knee}", lambda: live() and shown(".knee-label", "°"))
    camera.take("live_exercise", f"/#/sessions/{exercise}", lambda: live() and shown(".counter dd", "/min"))
    camera.take("live", f"/#/sessions/{walk}", lambda: live() and not shown(".numbers td", "–"))
    camera.take("live_six_minutes", f"/#/sessions/{corridor}", lambda: live() and shown(".walk-strip dd", " m"))
    camera.take("feedback", f"/#/feedback/{walk}", lambda: shown("main", ""))
    camera.take("calibration", f"/#/start/session/{walk}", lambda: shown(".duty-head", "Ready"))
    camera.take("floor", "/", lambda: shown(".card .light", "Good"))
    camera.take("report_timed", f"/#/sessions/{timed}/curves", lambda: over() and shown("th", "Walk back"))
    camera.take("report_body", f"/#/sessions/{squats}/curves", lambda: over() and shown("th", "Knee flexion range"))
    door.ask(f"sessions/{squats}", method="DELETE")


def _take_start(camera: Camera) -> None:
    """The steps of starting a session, without starting one."""
    camera.take("start_patient", "/#/start", lambda: camera.shown(".start-step h2", "Whose session is it?"))
    camera.press(ONWARD)
    camera.wait(lambda: camera.shown(".start-step h2", "What will be done?"), "the protocol")
    camera.press("input[name=task][value=ten_metre_walk]")
    camera.again("start_protocol", lambda: camera.shown(".about", "Walk along a marked way"))
    camera.press(ONWARD)
    camera.again("start_sensors", lambda: camera.shown(".placement", "Pelvis"))


def _take_site(camera: Camera, door: Door) -> None:
    """What those see who run the site."""
    shown = camera.shown
    for login, role in (("m.arnold", "therapist"), ("p.lindqvist", "viewer")):
        door.ask("accounts", {"login": login, "role": role, "password": "three quiet steps go"})
    camera.take("accounts", "/#/administration", lambda: shown("tbody", "m.arnold"))
    camera.take("audit", "/#/administration/audit", lambda: shown("tbody", "demo"))
    camera.take("bin", "/#/bin", lambda: shown("main", "Squat"))
    camera.take("system", "/#/system", lambda: shown("tbody", "imu/"))
    camera.take("api", "/docs", lambda: shown("#api", "/v1/sessions"))


def _begin(door: Door, source: str, speed: float | None, patient: str | None = None) -> str:
    wish: dict[str, Any] = {"source": source, "speed": speed, "patient": patient}
    return str(door.ask("sessions", wish)["id"])


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


if __name__ == "__main__":
    sys.exit(main())
