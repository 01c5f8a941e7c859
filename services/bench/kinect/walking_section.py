"""Walking on a treadmill: angles of the legs by ours, the printed filter and each frame alone."""

from collections.abc import Callable, Sequence

import numpy as np

from schemas.vocabulary import WHOLE_BODY
from services.bench.kinect import methods
from services.bench.kinect.camera import see
from services.bench.kinect.cells import Cell, agreement, mean_cells
from services.bench.kinect.methods import Method, Watched
from services.bench.kinect.walks import RECORDINGS, STANDING_S, WALKING, walk_trial
from services.bench.scoreboard import Row, informative
from services.biomech.whole_body.model import DOF
from services.biomech.whole_body.presets import CORRECTED
from services.ingest.errors import MissingFile
from services.ingest.synthetic.whole_body.people import TEST_PEOPLE, person
from services.ingest.synthetic.whole_body.programme import RATE_HZ

SCORED_FROM = int((STANDING_S + 1.5) * RATE_HZ)
"""Frame from which the person walks for sure."""
SCORED = tuple(DOF[f"{name}_{side}"] + 1 for name in ("hip_flexion", "hip_adduction", "hip_internal_rotation",
                                                     "knee_flexion") for side in ("right", "left"))  # fmt: skip
"""Angles, numbered from 1 as in the paper."""
METHODS: dict[str, Method] = {
    "each frame fitted alone": methods.raw,
    "literal eq. 5, flat Q": methods.printed(CORRECTED.process),
    "corrected eq. 5, flat Q": methods.filtered(CORRECTED, methods.published_start),
    "multibody fit, offline": methods.multibody,
    "ours": methods.ours,
}
BASELINE_PEOPLE = TEST_PEOPLE[:2]
"""Scored with the other methods, some of which take a minute a person; ours is scored on these, too."""
STEPS = len(METHODS) + 1
NOTE = (
    "walking: strides of three laboratories' recordings, closed, repeated and varied, on the simulated people of the "
    "other sections, clinic noise; ours has the same settings as everywhere, none was chosen on walking"
)


def watch(number: int, recording: str) -> Watched:
    """A person's walk as a camera of a clinic sees it. Raises MissingFile without the recording."""
    who = person(number)
    trial = walk_trial(who, recording)
    return Watched(who, trial, see(trial, number), "clinic")


def cells_of(method: Method, walks: Sequence[Watched]) -> list[Cell]:
    """Mean cells over walks."""
    found = []
    for watched in walks:
        estimate, truth = method(watched)[SCORED_FROM:], watched.angles[SCORED_FROM:]
        found.append([agreement(WALKING, k, estimate[:, k - 1], truth[:, k - 1]) for k in SCORED])
    return mean_cells(found)


def available() -> list[str]:
    """Recordings that are there. Raises MissingFile if none is."""
    found, missing = [], None
    for name, read in RECORDINGS.items():
        try:
            read()
        except MissingFile as error:
            missing = error
        else:
            found.append(name)
    if not found and missing is not None:
        raise missing
    return found


def walking_rows(advance: Callable[[], None]) -> list[Row]:
    """Every method on some people, ours on all; each person walks as one of the recordings does."""
    recordings = available()
    walks = {number: watch(number, recordings[number % len(recordings)]) for number in TEST_PEOPLE}
    rows: list[Row] = []
    for name, method in METHODS.items():
        cells = cells_of(method, [walks[number] for number in BASELINE_PEOPLE])
        rows += _rows(f"walking, persons 1 and 2: {name}", cells)
        advance()
    cells = cells_of(methods.ours, list(walks.values()))
    advance()
    flexions = [cell for cell in cells if WHOLE_BODY[cell.angle - 1].name.startswith(("hip_flexion", "knee"))]
    return [
        *rows,
        *_rows("walking: ours", cells),
        informative("walking: ours, hip and knee flexion", float(np.mean([c.rmsd_deg for c in flexions])), "deg"),
    ]


def _rows(title: str, cells: Sequence[Cell]) -> list[Row]:
    rows = []
    for name in ("hip_flexion", "hip_adduction", "hip_internal_rotation", "knee_flexion"):
        both = [cell for cell in cells if WHOLE_BODY[cell.angle - 1].name.startswith(name)]
        rmsd, zero_mean, correlation, extent = (float(np.mean([cell[k] for cell in both])) for k in (2, 3, 4, 5))
        label, detail = f"{title}, {name.replace('_', ' ')}", "flexion" not in name
        rows.append(informative(label, rmsd, "deg", detail=detail))
        rows.append(informative(f"{label}, zero-mean", zero_mean, "deg", detail=True))
        if extent >= 20.0:
            rows.append(informative(f"{label}, correlation", correlation, "", detail=True))
    return rows
