"""What `ambula up --demo` shows: simulated patients live at once, and one who has come five times, made meanwhile."""

import threading
import time
import urllib.error
from collections.abc import Sequence
from functools import partial

from services.bus.connection import Bus
from services.bus.settings import BusSettings
from services.cli import live, picture_visits
from services.cli.console import err, out
from services.cli.door import Door
from services.gateway.settings import GatewaySettings
from services.ingest.errors import SourceError
from services.ingest.source import open_source

SOURCES = (
    "synthetic:walk?speed=1.15&seed=1&duration=900",
    "synthetic:walk?speed=0.7&asymmetry=0.25&seed=2&duration=900",
    "synthetic:knee?exercise=1&seed=2&duration=900",
    "synthetic:tug?worn=1&seed=4&attempts=20",
    "synthetic:squat?person=2&repetitions=240",
    "neura_s02_walk",
)
NAMES = ("Ada Example", "Bruno Example", "Carla Example")
"""Of nobody: so that the directory has something to show."""
VISITS_NAME = "Dora Example"
VISITS_PACE = 5.0
"""Times real time: five visits are there after two minutes, and the live sessions keep their processors."""
PATIENCE_S = 600.0
KNOWN_S = 20.0
"""For the gateway to hear of a session that was started over the bus."""
LOST = (OSError, TimeoutError, KeyError, ValueError)
"""What talking to a gateway that is being stopped may end with."""


def start(settings: BusSettings, gateway: GatewaySettings, door: Door | None) -> None:
    """Start the live sessions; patients with names and visits follow in the background where somebody is signed in."""
    sessions = _start_live(settings)
    if door is not None:
        work = partial(_fill, door, gateway, sessions)
        threading.Thread(target=work, name="demo", daemon=True).start()


def _start_live(settings: BusSettings) -> list[str]:
    started = []
    with Bus.open(settings, "demo") as bus:
        for spec in SOURCES:
            try:
                open_source(spec)
            except SourceError as error:
                err.print(f"  not shown: {spec} ({error})", highlight=False)
                continue
            description = live.start_session(bus, spec, 1.0)
            started.append(description.session)
            out.print(f"  live: {description.title}")
            time.sleep(0.1)
    return started


def _fill(door: Door, gateway: GatewaySettings, sessions: Sequence[str]) -> None:
    try:
        if door.ask("patients")["total"]:
            return
        for session, name in zip(sessions, NAMES, strict=False):
            _belongs_to(door, session, _patient(door, name))
        shown = picture_visits.visits(
            door, gateway.data_dir, PATIENCE_S, pace=VISITS_PACE, database=gateway.database_url, name=VISITS_NAME
        )
    except LOST as error:
        err.print(f"  the patient with visits is not complete: {error}", highlight=False)
        return
    out.print(f"  progress over {len(shown.sessions)} visits: {gateway.url}/#/patients/{shown.code}")


def _patient(door: Door, name: str) -> str:
    code = str(door.ask("patients", {"population": "stroke_chronic"})["code"])
    door.ask(f"patients/{code}/name", {"name": name}, "PUT")
    return code


def _belongs_to(door: Door, session: str, code: str) -> None:
    end = time.monotonic() + KNOWN_S
    while True:
        try:
            door.ask(f"sessions/{session}", {"patient": code}, "PATCH")
            return
        except urllib.error.HTTPError as error:
            if error.code != 404 or time.monotonic() > end:
                raise
            time.sleep(0.2)
