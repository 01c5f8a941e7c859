"""`ambula tune`: optimises, prints what it found and what that gains on people who were not tuned on."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from services.bench.kinect.cells import KNEES, Cell, summary
from services.bench.kinect.motions import TASK_NAMES
from services.bench.kinect.tuning_runs import BEGINNINGS, SWEEPS, Tuned, cells_for, table_text, tune
from services.bench.kinect.workers import Spread, workers
from services.biomech.whole_body.descent import moves
from services.biomech.whole_body.parameters import GROUPS
from services.biomech.whole_body.task_presets import BASES, WAYS, Values, Way, values_of
from services.biomech.whole_body.tuned_tables import TABLES
from services.ingest.synthetic.whole_body.people import TEST_PEOPLE

NAMES = ("camera variance, m^2", "along bones, bone^2", *(name.replace("_", " ") for name in GROUPS))
TITLES: dict[Way, str] = {
    "published": "corrected filter, Q by eq. 8",
    "ours": "ours, Q by eq. 8",
    "hidden": "ours, R and Q by hidden centres, without a reference",
}
"""What each way is called."""


@dataclass(frozen=True)
class Order:
    """What is to be tuned, on whom and by how many processes."""

    ways: Sequence[Way] = WAYS
    tasks: Sequence[int] = tuple(TASK_NAMES)
    person: int = 0
    kind: str = "clinic"
    processes: int = 2

    def on(self) -> str:
        """Where the values come from, for the table of presets."""
        return (
            f"simulated person {self.person}, camera {self.kind!r}, drawn by the seeds [{self.person}, 2020], "
            f"[{self.person}, task, 7] and [{self.person}, task, 5]"
        )


def run(order: Order, console: Console, file: Path | None = None) -> list[Tuned]:
    """Tune, print, and write the table of presets if there is a file; tasks that were not tuned keep their values.

    Raises:
        ValueError: the person is one of those who are scored, or there is no process.
        MissingFile: the recorded squats are not there.
    """
    if order.person in TEST_PEOPLE:
        raise ValueError(f"person {order.person} is scored; tune on another, e.g. 0, 8 or 9")
    with workers(order.processes) as spread:
        found = _tune_all(order, spread, console)
        for way in order.ways:
            console.print(_values_table(TITLES[way], [one for one in found if one.way == way]))
        console.print(_scores_table(order, found, spread))
    if file is not None:
        tables: dict[Way, dict[int, Values]] = {way: dict(TABLES[way]) for way in WAYS}
        for one in found:
            tables[one.way][one.task] = one.values
        file.write_text(table_text(order.on(), tables), encoding="utf-8")
    return found


def _tune_all(order: Order, spread: Spread, console: Console) -> list[Tuned]:
    found = []
    with Progress(console=console, transient=True) as progress:
        for way in order.ways:
            for task in order.tasks:
                total = SWEEPS * len(moves()) if way == "hidden" else None
                bar = progress.add_task(f"{way}, {TASK_NAMES[task]}", total=total)
                found.append(tune(way, task, order.person, order.kind, spread, lambda bar=bar: progress.advance(bar)))  # type: ignore[misc]
                progress.update(bar, total=1, completed=1)
    return found


def _values_table(title: str, found: Sequence[Tuned]) -> Table:
    """Where each value began and ended."""
    table = Table(title=title)
    table.add_column("")
    for one in found:
        table.add_column(f"{one.task} {TASK_NAMES[one.task]}", justify="right")
    for name, pairs in zip(NAMES, zip(*map(_pairs, found), strict=True), strict=True):
        table.add_row(name, *(f"{a:.3g} -> {b:.3g}" if a != b else f"{a:.3g}" for a, b in pairs))
    unit = found[0].unit
    table.add_row(f"cost, {unit}", *(f"{one.cost_at_start:.2f} -> {one.cost_at_optimum:.2f}" for one in found))
    return table


def _pairs(one: Tuned) -> Iterator[tuple[float, float]]:
    return zip(values_of(one.start), one.values, strict=True)


def _scores_table(order: Order, found: Sequence[Tuned], spread: Spread) -> Table:
    """Cells of the people who were not tuned on, with common settings and with those found."""
    table = Table(title=f"persons {TEST_PEOPLE[0]} to {TEST_PEOPLE[-1]}, camera {order.kind}: RMSD, zero-mean, deg; CC")
    for heading in ("", "all", *(f"{task} {TASK_NAMES[task]}" for task in order.tasks), "knees"):
        table.add_column(heading, justify="right" if heading else "left", min_width=9)
    for way in order.ways:
        tuned = {one.task: one for one in found if one.way == way}
        rows = {
            "as it began": {task: one.start for task, one in tuned.items()},
            "tuned": {task: one.optimum for task, one in tuned.items()},
        }
        if way == "hidden":
            rows["common settings"] = dict.fromkeys(tuned, BASES[way])
        for name, settings in rows.items():
            cells = cells_for(settings.__getitem__, BEGINNINGS[way], order.kind, TEST_PEOPLE, order.tasks, spread)
            table.add_row(f"{way}: {name}", *_figures(cells, order.tasks))
    return table


def _figures(cells: Sequence[Cell], tasks: Sequence[int]) -> list[str]:
    parts = [list(cells), *([cell for cell in cells if cell.task == task] for task in tasks)]
    knees = [cell for cell in cells if cell.angle in KNEES and cell.task in (1, 2)]
    return [_figure(part) for part in (*parts, knees)]


def _figure(cells: Sequence[Cell]) -> str:
    if not cells:
        return ""
    rmsd, zero_mean, correlation = summary(cells)
    return f"{rmsd:.2f} {zero_mean:.2f} {correlation:.2f}"
