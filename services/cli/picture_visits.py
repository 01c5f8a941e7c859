"""A patient to be shown: several real visits of a simulated one who walks faster each time, weeks apart."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

from services.cli.door import Door
from services.gateway.access.scope import EVERYTHING
from services.gateway.database import open_database
from services.gateway.settings import GatewaySettings
from services.gateway.tables import SessionRow

PERSON = {"year_of_birth": 1957, "sex": "female", "population": "stroke_chronic", "paretic_side": "left"}
SPEEDS = (0.50, 0.53, 0.60, 0.68, 0.74)
WALK = "synthetic:walk?patient=2&affected=1&speed={speed}&seed=11&duration=100"
SAID = {
    "aid": "cane",
    "orthosis": "none",
    "footwear": "shoes",
    "physical_assistance": False,
    "speed_instruction": "comfortable",
}
LAST = datetime(2026, 11, 16, 9, 30, tzinfo=UTC)
BETWEEN = timedelta(days=14)
TREATMENTS = (("2026-10-01", "gait_training"), ("2026-10-26", "botulinum_toxin"))
DONE = ("finished", "interrupted", "failed")


@dataclass(frozen=True)
class Shown:
    """Whom the pictures show: code, and sessions from the first visit to the last."""

    code: str
    sessions: list[str]


def visits(
    door: Door, data: Path, patience_s: float, *, pace: float | None = None, database: str = "", name: str | None = None
) -> Shown:
    """Walk all visits, then move them apart in the database (a URL; empty: the one in the folder `data`).

    All at once and as fast as the services follow; with a `pace`, times real time, one after the other. `name`: who it
    is, for the directory. Raises TimeoutError.
    """
    code = str(door.ask("patients", PERSON)["code"])
    if name is not None:
        door.ask(f"patients/{code}/name", {"name": name}, "PUT")
    for date, kind in TREATMENTS:
        door.ask(f"patients/{code}/treatments", {"date": date, "kind": kind})
    end, walks = time.monotonic() + patience_s, []
    for speed in SPEEDS:
        walks.append(_begin(door, code, speed, pace))
        if pace is not None:
            _wait(door, walks, end)
    _wait(door, walks, end)
    _move_apart(database or GatewaySettings(data_dir=data, database="").database_url, walks)
    return Shown(code, walks)


def _wait(door: Door, walks: Sequence[str], end: float) -> None:
    while not all(_is_kept(door, walk) for walk in walks):
        if time.monotonic() > end:
            raise TimeoutError(f"{len(walks)} walks did not end in time")
        time.sleep(0.5)


def _begin(door: Door, code: str, speed: float, pace: float | None) -> str:
    wish = {"source": WALK.format(speed=speed), "speed": pace, "patient": code, "conditions": SAID}
    return str(door.ask("sessions", wish)["id"])


def _is_kept(door: Door, walk: str) -> bool:
    """Over, and sealed by the archive, so that a report can name its recording."""
    files = door.ask(f"sessions/{walk}/recordings")
    return door.ask(f"sessions/{walk}")["state"] in DONE and bool(files) and all(each["sha256"] for each in files)


def _move_apart(url: str, walks: Sequence[str]) -> None:
    database = open_database(url)
    try:
        with database.transaction(EVERYTHING) as records:
            for place, walk in enumerate(reversed(walks)):
                records.get_one(SessionRow, walk).started = LAST - place * BETWEEN
    finally:
        database.close()
