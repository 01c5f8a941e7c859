"""Scoreboard of the Rhythmic EKF: every experiment of the paper, and what became of its future work.

Seeds of single-joint motions are 60000 and on; parameters were chosen on seeds below 2000.
"""

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from rich.progress import Progress

from services.bench.joukov.gait_section import (
    EVENT_SUBJECTS,
    event_rows,
    events_section,
    strides_section,
    stroke_strides,
)
from services.bench.joukov.marching import (
    FIRST_SEED,
    OURS,
    PARTICIPANTS,
    PLAIN,
    TRIALS,
    Scores,
    Tuning,
    study_trial,
    trace_tuning,
    tune,
)
from services.bench.joukov.marching_charts import follow_example
from services.bench.joukov.marching_section import marching_section
from services.bench.joukov.motions import JointMotion, motion_kinds
from services.bench.joukov.neura import study_neura
from services.bench.joukov.neura_section import missing_section, neura_section
from services.bench.joukov.report import write_report
from services.bench.joukov.sections import Section
from services.bench.joukov.simulation import study_sweep
from services.bench.joukov.single_joint_sections import curve_section, simulation_section
from services.bench.joukov.study import Study, study_motion
from services.bench.rhythm.stride_shapes import StrideShapes, load_stride_shapes
from services.bench.scoreboard import Row, Scoreboard
from services.ingest.errors import MissingFile, SourceError

PROCESSES = 2
SEED = 60000
MOTIONS = 100
FEWEST_PARTICIPANTS = 2
MOTIONS_PER_PARTICIPANT = 15
MOST_WALKS, MOTIONS_PER_WALK = 2, 50
HOLD_S = {"simulation": 0.0, "simulation with hold": 40.0}
"""s at 1 rad/s before the ramp: both readings of the paper."""
NOTE = (
    "S: variance of the jerk per 10 ms sample. S*: smallest S at which the plain EKF's position is within 1 % of its "
    "best; of the marches, on a participant who is not scored. Simulation: baseline is the plain EKF; where a row says "
    "'of plain', its value is the ratio to the plain EKF and baseline the literal oscillator's."
)


@dataclass(frozen=True)
class Work:
    """Two processes and a progress bar."""

    pool: ProcessPoolExecutor
    progress: Progress
    motions: int

    @property
    def participants(self) -> int:
        """How many march."""
        return min(PARTICIPANTS, max(FEWEST_PARTICIPANTS, self.motions // MOTIONS_PER_PARTICIPANT))

    def each(self, title: str, study: Callable[[Any], Any], tasks: Iterable[Any]) -> list[Any]:
        """`study` of every task, in their order."""
        todo = list(tasks)
        return list(self.progress.track(self.pool.map(study, todo), total=len(todo), description=title))


def run(
    json_path: Path | None = None, motions: int = MOTIONS, parts: Sequence[str] = (), report: Path | None = None
) -> Scoreboard:
    """Score the filters.

    Args:
        json_path: where to write the rows as well.
        motions: how many of each kind.
        parts: names of PARTS; none is all.
        report: folder for a Markdown report with charts.
    """
    if motions < 1:
        raise ValueError(f"the number of motions is to be at least 1, not {motions}")
    with Progress() as progress, ProcessPoolExecutor(PROCESSES, mp_context=get_context("spawn")) as pool:
        work = Work(pool, progress, motions)
        sections = [section for name, part in PARTS.items() if not parts or name in parts for section in part(work)]
    title = f"joukov, {motions} motions of each kind"
    scoreboard = Scoreboard(title, [row for section in sections for row in section.rows], NOTE)
    if json_path is not None:
        scoreboard.write_json(json_path)
    if report is not None:
        write_report(report, title, sections)
    return scoreboard


def simulation(work: Work) -> list[Section]:
    """The published simulation, in both readings."""
    sweeps = {
        name: work.each(name, partial(study_sweep, hold_s=hold_s), range(SEED, SEED + work.motions))
        for name, hold_s in HOLD_S.items()
    }
    return [simulation_section(sweeps, HOLD_S)]


def curve(work: Work) -> list[Section]:
    """One joint over the process noise."""
    shapes, skipped = _shapes()
    studies: dict[str, list[Study]] = {
        kind: work.each(kind, partial(study_kind, make=make), range(SEED, SEED + work.motions))
        for kind, make in motion_kinds(shapes).items()
    }
    section = curve_section(studies)
    return [Section(section.title, section.paragraphs, [*section.rows, *skipped], section.tables, section.charts)]


def tables(work: Work) -> list[Section]:
    """Tables I to IV and segmentation: virtual participants who march, and a recorded walk."""
    tuning = tune(*work.each("tuning", trace_tuning, [PLAIN, OURS]))
    seeds = range(FIRST_SEED, FIRST_SEED + work.participants)
    tasks = [(seed, trial) for trial in TRIALS for seed in seeds]
    scores = work.each("marching", partial(study_trial, tuning=tuning), tasks)
    trials: dict[str, dict[str, Scores]] = {trial: {} for trial in TRIALS}
    for (seed, trial), found in zip(tasks, scores, strict=True):
        trials[trial][f"participant {seed - FIRST_SEED + 1}"] = found
    example, neura = work.each("recorded walk", _follow, [(name, tuning) for name in ("march", "neura")])
    return [marching_section(trials, tuning, example), neura]


def strides(work: Work) -> list[Section]:
    """Strides of a stroke survivor."""
    return [strides_section(work.each("strides", stroke_strides, [0])[0])]


def events(work: Work) -> list[Section]:
    """Gait events against force plates."""
    found: list[list[Row]] = work.each("events", event_rows, EVENT_SUBJECTS)
    return [events_section([row for rows in found for row in rows])]


def walks(work: Work) -> list[Section]:
    """The whole filter on synthetic walks."""
    from services.bench.joukov.walks_section import study_seed, walks_section

    seeds = range(max(1, min(MOST_WALKS, work.motions // MOTIONS_PER_WALK)))
    return [walks_section(work.each("synthetic walks", study_seed, seeds))]


PARTS: dict[str, Callable[[Work], list[Section]]] = {
    "simulation": simulation,
    "curve": curve,
    "tables": tables,
    "walks": walks,
    "strides": strides,
    "events": events,
}
"""Experiments by the name that `ambula bench joukov 100 tables` takes."""


def _follow(task: tuple[str, Tuning]) -> Any:
    """The marching example, or the section of the recorded walk."""
    name, tuning = task
    if name == "march":
        return follow_example(tuning)
    try:
        return neura_section(study_neura(tuning), tuning)
    except SourceError as missing:
        return missing_section(str(missing))


def _shapes() -> tuple[StrideShapes | None, list[Row]]:
    try:
        return load_stride_shapes(), []
    except MissingFile as missing:
        return None, [Row("knee: skipped", None, "", str(missing), None, None)]


def study_kind(seed: int, make: Callable[[int], JointMotion]) -> Study:
    """All filters on the motion of a seed."""
    return study_motion(make(seed))
