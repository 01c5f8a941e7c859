"""Table 1 of the paper for every method: angles by tasks, under both noise models, and every gate."""

from collections.abc import Callable, Sequence

import numpy as np

from services.bench.kinect.cells import KNEES, LARGE_DEG, PUBLISHED, Cell, mean_cells, summary
from services.bench.kinect.contenders import BEST, MUST_SHOW, OPTIMISED, Result, run_all
from services.bench.kinect.gates import angle_name, cell_rows, gain_row, our_gates, projection_row
from services.bench.kinect.motions import TASK_NAMES, TASKS
from services.bench.kinect.simulated_section import NOTE, PROCESSES, TRIALS
from services.bench.kinect.workers import workers
from services.bench.report import Section, Table
from services.bench.scoreboard import Row, informative
from services.ingest.synthetic.whole_body.people import TEST_PEOPLE

KINDS = ("clinic", "paper")
STEPS = len(KINDS) * len(MUST_SHOW) * TRIALS
SHOWN = (OPTIMISED, BEST)
"""Whose cells the terminal shows; the report has all."""
LEGEND = (
    "A cell: RMSD (SD over people) / zero-mean RMSD, deg, correlation; no correlation where the angle moves less than "
    f"{LARGE_DEG:g} deg. Frames after a method diverged count as wrong by half a turn."
)


def table_section(advance: Callable[[], None]) -> Section:
    """Six methods on seven people under two noise models."""
    rows: list[Row] = []
    tables: list[Table] = []
    with workers(PROCESSES) as spread:
        for kind in KINDS:
            found = run_all(MUST_SHOW, kind, TEST_PEOPLE, spread, advance)
            tables.append(methods_table(kind, found))
            tables += [cells_table(f"{kind}: {name}", results) for name, results in found.items()]
            rows += _rows(kind, found)
    return Section("table 1 of the paper", [NOTE, LEGEND], [*rows, projection_row()], tables)


def shown(tables: Sequence[Table]) -> list[Table]:
    """Those for the terminal: of table 1 some, of other sections all."""
    hidden = {f"{kind}: {name}" for kind in KINDS for name in MUST_SHOW if name not in SHOWN}
    return [one for one in tables if one.caption not in hidden]


def _rows(kind: str, found: dict[str, list[Result]]) -> list[Row]:
    cells = {name: mean_cells([result.cells for result in results]) for name, results in found.items()}
    rows = our_gates(kind, found[BEST])
    gain = gain_row(kind, summary(cells[BEST])[0], summary(cells[OPTIMISED])[0])
    rows.append(gain if kind == "clinic" else informative(gain.name, gain.value, "%"))
    return [*rows, *(cell_rows(cells[BEST]) if kind == "clinic" else [])]


def methods_table(kind: str, found: dict[str, list[Result]]) -> Table:
    """One line per method."""
    header = ("", "34 cells", "15 moving", "knees", *(f"{k} {TASK_NAMES[k]}" for k in TASKS), "frames beyond limits")
    lines = []
    for name, results in found.items():
        cells = mean_cells([result.cells for result in results])
        parts = [
            cells, [c for c in cells if c.moves], [c for c in cells if c.angle in KNEES and c.task in (1, 2)],
            *([c for c in cells if c.task == task] for task in TASKS),
        ]  # fmt: skip
        lines.append((name, *map(_mean, parts), str(sum(result.outside for result in results))))
    return Table(f"{kind}: methods, RMSD / zero-mean RMSD in deg, correlation", header, lines)


def _mean(cells: Sequence[Cell]) -> str:
    rmsd, zero_mean, correlation = summary(cells)
    return f"{rmsd:.1f} / {zero_mean:.1f}, {correlation:.2f}"


def cells_table(caption: str, results: Sequence[Result]) -> Table:
    """Angles by tasks."""
    trials: dict[tuple[int, int], list[Cell]] = {}
    for result in results:
        for cell in result.cells:
            trials.setdefault((cell.task, cell.angle), []).append(cell)
    angles = sorted({angle for task in PUBLISHED.values() for angle in task})
    lines = [
        (f"{angle} {angle_name(angle)}", *(cell_text(trials.get((task, angle), [])) for task in TASKS))
        for angle in angles
    ]
    return Table(caption, ("angle", *(f"{task} {TASK_NAMES[task]}" for task in TASKS)), lines)


def cell_text(people: Sequence[Cell]) -> str:
    """One cell, one entry of `people` each; empty where the paper reports none."""
    if not people:
        return ""
    rmsd, zero_mean, correlation, moved = np.mean([cell[2:] for cell in people], axis=0)
    deviation = np.std([cell.rmsd_deg for cell in people], ddof=1) if len(people) > 1 else 0.0
    agreement = f"{correlation:.2f}" if moved >= LARGE_DEG else "small movement"
    return f"{rmsd:.1f} ({deviation:.1f}) / {zero_mean:.1f}, {agreement}"
