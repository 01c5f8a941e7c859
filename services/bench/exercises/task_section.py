"""Squats, steps and tilts of simulated people before a camera, through the whole chain."""

import math
from collections.abc import Sequence

from rich.progress import track

from schemas.vocabulary import Task
from services.bench.exercises.scores import Tally, mean, mean_absolute
from services.bench.exercises.sessions import through_chain
from services.bench.exercises.truths import true_repetitions
from services.bench.scoreboard import Row, at_most, informative

MOTIONS = {
    "squat": Task.SQUAT,
    "steps": Task.STEPPING,
    "tilt_forward": Task.TRUNK_TILT_SAGITTAL,
    "tilt_aside": Task.TRUNK_TILT_FRONTAL,
}
NAMES = {"squat": "squat", "steps": "stepping", "tilt_forward": "tilt forward", "tilt_aside": "tilt aside"}
MANNERS = ("", "hold=5&repetitions=6", "asymmetry=0.25", "partials=0.2", "tempo=6&repetitions=6")
"""One person after the other does it plainly, with holds, unevenly, with partial ones, slowly."""
ONE_SIDED = "tilt_forward"
"""Has no sides, so nobody does it unevenly."""
FIRST_PERSON = 101
"""Nothing was chosen on the people from here on."""


def task_rows(people: int, motions: Sequence[str] = tuple(MOTIONS)) -> list[Row]:
    """All tasks; each person does one of the manners."""
    rows: list[Row] = []
    for motion in motions:
        tally = Tally()
        for number in track(range(FIRST_PERSON, FIRST_PERSON + people), NAMES[motion]):
            manner = MANNERS[number % len(MANNERS)]
            if motion == ONE_SIDED and manner.startswith("asymmetry"):
                manner = "fatigue=0.4"
            session = through_chain(f"synthetic:{motion}?person={number}&seed={number}&{manner}".rstrip("&"))
            tally.add(session.repetitions, true_repetitions(session, MOTIONS[motion]))
        rows += _figures(NAMES[motion], tally)
    return rows


def _figures(name: str, tally: Tally) -> list[Row]:
    degrees = math.degrees
    rows = [
        at_most(f"{name}: missed or invented", tally.wrong_percent, "%", 3.0, tally.true),
        informative(f"{name}: missed", float(tally.missed), "", detail=True),
        informative(f"{name}: invented", float(tally.extra), "", detail=True),
        at_most(f"{name}: range, mean absolute error", degrees(mean_absolute(tally.ranges)), "deg", 5.0),
        informative(f"{name}: range, bias", degrees(mean(tally.ranges)), "deg"),
        at_most(f"{name}: start, mean absolute error", mean_absolute(tally.starts), "s", 0.2),
        at_most(f"{name}: end, mean absolute error", mean_absolute(tally.ends), "s", 0.2),
        at_most(f"{name}: hold, mean absolute error", mean_absolute(tally.holds), "s", 0.3),
    ]
    if name in (NAMES["squat"], NAMES["steps"]):
        seen = 100.0 * len(tally.knees) / max(tally.knees_asked, 1)
        rows.append(
            at_most(f"{name}: knee range, mean absolute error", degrees(mean_absolute(tally.knees)), "deg", 8.0)
        )
        rows.append(informative(f"{name}: knee ranges told", seen, "%", detail=True))
    if tally.symmetries and name != NAMES[ONE_SIDED]:
        rows.append(at_most(f"{name}: right / left, mean absolute error", mean_absolute(tally.symmetries), "1", 0.1))
    if tally.partial:
        share = 100.0 * tally.partial_counted / tally.partial
        rows.append(informative(f"{name}: partial ones counted", share, "%", tally.partial))
    return rows
