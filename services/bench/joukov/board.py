"""Scoreboard of the Rhythmic EKF: the published simulation over many motions, and the curve over the process noise.

Seeds are 60000 and on; parameters were chosen on seeds below 2000.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from rich.progress import Progress

from services.bench.joukov.curve import curve_rows
from services.bench.joukov.motions import JointMotion, motion_kinds
from services.bench.joukov.report import write_report
from services.bench.joukov.simulation import PUBLISHED_DEG, SweepStudy, simulation_rows, study_sweep
from services.bench.joukov.study import Study, study_motion
from services.bench.rhythm.stride_shapes import StrideShapes, load_stride_shapes
from services.bench.scoreboard import Row, Scoreboard, informative
from services.ingest.errors import MissingFile

PROCESSES = 2
SEED = 60000
MOTIONS = 100
HOLD_S = {"simulation": 0.0, "simulation with hold": 40.0}
"""s at 1 rad/s before the ramp: both readings of the paper."""
NOTE = (
    "S: variance of the jerk per 10 ms sample. S*: smallest S at which the plain EKF's position is within 1 % of its "
    "best. Simulation: baseline is the plain EKF; elsewhere 'of plain' is the ratio to it and baseline the published "
    "estimator's."
)

Score = Callable[[str, Callable[[int], Any]], list[Any]]


def run(json_path: Path | None = None, motions: int = MOTIONS, report: Path | None = None) -> Scoreboard:
    """Score the filters.

    Args:
        json_path: where to write the rows as well.
        motions: how many of each kind.
        report: folder for a Markdown report with charts.
    """
    if motions < 1:
        raise ValueError(f"the number of motions is to be at least 1, not {motions}")
    shapes, rows = _shapes()
    with Progress() as progress, ProcessPoolExecutor(PROCESSES, mp_context=get_context("spawn")) as pool:
        seeds = range(SEED, SEED + motions)
        score = partial(_score_all, pool, progress, seeds)
        sweeps: dict[str, list[SweepStudy]] = {
            name: score(name, partial(study_sweep, hold_s=hold_s)) for name, hold_s in HOLD_S.items()
        }
        studies: dict[str, list[Study]] = {
            kind: score(kind, partial(study_seed, make=make)) for kind, make in motion_kinds(shapes).items()
        }
    rows = _rows(sweeps, studies) + rows
    scoreboard = Scoreboard(f"joukov, {motions} motions of each kind", rows, NOTE)
    if json_path is not None:
        scoreboard.write_json(json_path)
    if report is not None:
        write_report(report, scoreboard, sweeps, studies)
    return scoreboard


def _shapes() -> tuple[StrideShapes | None, list[Row]]:
    try:
        return load_stride_shapes(), []
    except MissingFile as missing:
        return None, [Row("knee: skipped", None, "", str(missing), None, None)]


def _score_all(
    pool: ProcessPoolExecutor, progress: Progress, seeds: Sequence[int], title: str, study: Callable[[int], Any]
) -> list[Any]:
    return list(progress.track(pool.map(study, seeds), total=len(seeds), description=title))


def study_seed(seed: int, make: Callable[[int], JointMotion]) -> Study:
    """All filters on the motion of a seed."""
    return study_motion(make(seed))


def _rows(sweeps: dict[str, list[SweepStudy]], studies: dict[str, list[Study]]) -> list[Row]:
    ekf, rhythmic = PUBLISHED_DEG
    rows = [informative("as published, one motion: position", rhythmic, "deg", ekf)]
    for name, sweep in sweeps.items():
        rows += simulation_rows(name, sweep, detail=HOLD_S[name] > 0.0)
    for kind, study in studies.items():
        rows += curve_rows(kind, study)
    return rows
