"""Dials of the synthetic people who walk a corridor for time, or a measured distance."""

from dataclasses import dataclass
from typing import ClassVar

from services.ingest.synthetic.dials import dial
from services.ingest.synthetic.parameters import SessionParameters


@dataclass(frozen=True)
class CorridorParameters(SessionParameters):
    """How somebody walks up and down a straight corridor."""

    speed: float = dial(1.1, 0.3, 1.6, "m/s, mean over a stride on the straight, at the start")
    asymmetry: float = dial(0.0, 0.0, 0.5, "share by which the left leg swings less; its steps also come off beat")
    turn_time: float = dial(2.5, 1.0, 12.0, "s that a turn takes")


@dataclass(frozen=True)
class SixMinutesParameters(CorridorParameters):
    """As far as possible within a time: up and down a corridor, with rests while the clock runs."""

    motion: ClassVar[str] = "six_minutes"

    duration: float = dial(360.0, 20.0, 3600.0, "s that the test lasts by the clock, rests included")
    corridor: float = dial(30.0, 5.0, 100.0, "m from turning point to turning point")
    decline: float = dial(0.08, 0.0, 0.6, "share by which steps are shorter at the end than at the start")
    rests: int = dial(0, 0, 10, "times that the person stands and rests")
    rest_time: float = dial(12.0, 3.0, 300.0, "s of each rest")


@dataclass(frozen=True)
class TenMetresParameters(CorridorParameters):
    """A short walkway whose middle is timed, several times."""

    motion: ClassVar[str] = "ten_metres"

    duration: float = dial(0.0, 0.0, 3600.0, "s, standing included; 0: as long as all trials take")
    walkway: float = dial(10.0, 4.0, 50.0, "m from the start to the end of the walkway")
    zone_from: float = dial(2.0, 0.0, 50.0, "m from the start: where the timed zone begins")
    zone_to: float = dial(8.0, 0.5, 50.0, "m from the start: where the timed zone ends")
    trials: int = dial(3, 1, 20, "times that the walkway is walked")
    start: int = dial(0, 0, 1, "0 from standing, with a pause between trials; 1 walks on, turning at both ends")
