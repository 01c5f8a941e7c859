"""Trials of simulated people as a camera saw them, and the parts of them that one process works on."""

from collections.abc import Callable
from functools import cache
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.bench.kinect import methods
from services.bench.kinect.camera import see
from services.bench.kinect.cells import PUBLISHED, Cell, score
from services.bench.kinect.methods import Watched
from services.bench.kinect.motions import Trial, trial
from services.biomech.whole_body.constrained_ekf import FilterSettings
from services.biomech.whole_body.hidden_centres import log_misfit
from services.biomech.whole_body.start import Start
from services.biomech.whole_body.tuning import Recording, replay, residuals
from services.ingest.synthetic.whole_body.people import person

Array = NDArray[np.float64]
Beginning = Literal["published", "ours"]
STARTS: dict[Beginning, Callable[[Watched], Start]] = {
    "published": methods.published_start, "ours": methods.our_start,
}  # fmt: skip


class Case(NamedTuple):
    """One person's trial under a camera, and how a filter starts on it. Small enough to send to another process."""

    person: int
    task: int
    kind: str
    beginning: Beginning


@cache
def truth(number: int, task: int) -> Trial:
    """A person's trial without a camera."""
    return trial(person(number), task)


@cache
def watch(number: int, task: int, kind: str) -> Watched:
    """A person's trial as a camera of that kind sees it."""
    done = truth(number, task)
    return Watched(person(number), done, see(done, number, kind), kind)


@cache
def recording_of(case: Case) -> Recording:
    """The case as a filter takes it."""
    watched = watch(case.person, case.task, case.kind)
    return methods.recording_of(watched, STARTS[case.beginning](watched))


def estimate(case: Case, settings: FilterSettings) -> Array:
    """(n, 22) rad."""
    return replay(recording_of(case), settings)[0]


def residuals_of(work: tuple[Case, FilterSettings]) -> Array:
    """Error of the task's angles, rad, as eq. 8 sums it."""
    case, settings = work
    return residuals([recording_of(case)], settings, [angle - 1 for angle in PUBLISHED[case.task]])


def log_misfit_of(work: tuple[Case, FilterSettings, int]) -> float:
    """Log of the misfit of hidden centres, drawn by a seed; the truth is not looked at."""
    case, settings, seed = work
    return log_misfit([recording_of(case)._replace(angles=None)], settings, (seed,))


def cells_of_case(work: tuple[Case, FilterSettings]) -> list[Cell]:
    """Agreement of the task's angles."""
    case, settings = work
    return score(case.task, estimate(case, settings), watch(case.person, case.task, case.kind).angles)
