"""Every method by name, and what one process does with one trial of one of them."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.bench.kinect import methods
from services.bench.kinect.cells import Cell, score
from services.bench.kinect.methods import Method, Watched
from services.bench.kinect.motions import TASKS
from services.bench.kinect.trials import truth, watch
from services.bench.kinect.workers import Spread
from services.biomech.whole_body.constrained_ekf import OURS
from services.biomech.whole_body.parameters import LIMITS_DEG, NO_PRIORS, ProcessNoise, per_angle
from services.biomech.whole_body.presets import CORRECTED, UNCONSTRAINED
from services.biomech.whole_body.start import Start
from services.biomech.whole_body.task_presets import Way, numbered
from services.biomech.whole_body.tuning import frequency_tuned
from services.ingest.synthetic.whole_body.people import TUNING_PERSON
from services.ingest.synthetic.whole_body.programme import RATE_HZ

Array = NDArray[np.float64]

RAW, LITERAL, BY_FREQUENCY = "raw: each frame fitted alone", "literal eq. 5, Q eq. 6-7", "corrected, Q eq. 6-7"
OPTIMISED, MULTIBODY, BEST = "corrected, Q eq. 8 on one person", "multibody fit, offline", "ours"
MUST_SHOW = (RAW, LITERAL, BY_FREQUENCY, OPTIMISED, MULTIBODY, BEST)
"""The rows of the issue, from raw to best."""
PER_TASK, REFERENCE_FREE = "ours, Q eq. 8 on one person, per task", "ours, hidden centres of one person, per task"


def frequency_process(task: int) -> ProcessNoise:
    """Eq. 6 and 7 on the tuning person's reference."""
    return frequency_tuned(truth(TUNING_PERSON, task).q, RATE_HZ)


def published_way(task: int) -> Method:
    """Q by eq. 8 on the tuning person, the paper's start and its one constant R."""
    return methods.filtered(numbered("published", task), methods.published_start)


def per_task(way: Way) -> Callable[[int], Method]:
    """Ours with what was tuned for the task."""
    return lambda task: methods.filtered(numbered(way, task), methods.our_start)


def _unbiased(watched: Watched) -> Start:
    return methods.our_start(watched, biased=False)


CONTENDERS: dict[str, Callable[[int], Method]] = {
    RAW: lambda _: methods.raw,
    "unconstrained, Q eq. 6-7": lambda task: methods.filtered(
        replace(UNCONSTRAINED, process=frequency_process(task)), methods.published_start
    ),
    "literal eq. 5, flat Q": lambda _: methods.printed(CORRECTED.process),
    LITERAL: lambda task: methods.printed(frequency_process(task)),
    BY_FREQUENCY: lambda task: methods.filtered(
        replace(CORRECTED, process=frequency_process(task)), methods.published_start
    ),
    "corrected, flat Q": lambda _: methods.filtered(CORRECTED, methods.published_start),
    OPTIMISED: published_way,
    MULTIBODY: lambda _: methods.multibody,
    "ours without biases": lambda _: methods.filtered(OURS, _unbiased),
    "ours without soft priors": lambda _: methods.filtered(replace(OURS, priors=NO_PRIORS), methods.our_start),
    "ours without limits": lambda _: methods.filtered(replace(OURS, constrained=False), methods.our_start),
    PER_TASK: per_task("ours"),
    REFERENCE_FREE: per_task("hidden"),
    BEST: lambda _: methods.ours,
}
"""By name: the method for a task. Tuned values are those of `tuned_tables`, found on the tuning person."""


class Piece(NamedTuple):
    """One method on one person's trial."""

    name: str
    kind: str
    person: int
    task: int


class Result(NamedTuple):
    """What became of it."""

    cells: list[Cell]
    outside: int  # frames with an angle beyond its limits, or not finite


def angles_of(piece: Piece) -> tuple[Array, Watched]:
    """(n, 22) rad of the method, and what was watched."""
    watched = watch(piece.person, piece.task, piece.kind)
    return CONTENDERS[piece.name](piece.task)(watched), watched


def result_of(piece: Piece) -> Result:
    """Run one method on one trial."""
    angles, watched = angles_of(piece)
    return Result(score(piece.task, angles, watched.angles), outside(angles))


def outside(angles: Array) -> int:
    """Frames with an angle beyond its limits; pelvis_rotation has its own, against the heading at the start."""
    low, high = per_angle(LIMITS_DEG).T
    inside = ((angles >= low - 1e-12) & (angles <= high + 1e-12))[:, 1:].all(axis=1)
    return int((~inside).sum())


def run_all(
    names: Sequence[str], kind: str, people: Iterable[int], spread: Spread, advance: Callable[[], None]
) -> dict[str, list[Result]]:
    """Every method on every task of every person; `advance` after each trial."""
    pieces = [Piece(name, kind, number, task) for name in names for number in people for task in TASKS]
    found: dict[str, list[Result]] = {name: [] for name in names}
    for piece, result in zip(pieces, spread(result_of, pieces), strict=True):
        found[piece.name].append(result)
        advance()
    return found
