"""The three ways to tune, each task for itself on one person, over processes; and what that gains on other people."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from services.bench.kinect.cells import Cell, mean_cells
from services.bench.kinect.methods import STANDING_FRAMES
from services.bench.kinect.trials import Beginning, Case, cells_of_case, log_misfit_of, recording_of, residuals_of
from services.bench.kinect.workers import Spread
from services.biomech.whole_body.constrained_ekf import FilterSettings
from services.biomech.whole_body.hidden_centres import from_still_part, tuned_by_hidden_centres
from services.biomech.whole_body.task_presets import BASES, Values, Way, values_of
from services.biomech.whole_body.tuning import Search, tuned_against_reference

BEGINNINGS: dict[Way, Beginning] = {"published": "published", "ours": "ours", "hidden": "ours"}
SEARCH = Search(1e-1, 1e5, 8)
"""White jerk, rad^2/s^5: the paper's bounds are of the held jerk, five decades as well."""
HIDDEN_SEEDS = (0, 1)
SWEEPS = 3


@dataclass(frozen=True)
class Tuned:
    """One task tuned one way."""

    way: Way
    task: int
    start: FilterSettings
    optimum: FilterSettings
    unit: str
    cost_at_start: float
    cost_at_optimum: float

    @property
    def values(self) -> Values:
        """For the table of presets."""
        return values_of(self.optimum)


def tune(way: Way, task: int, number: int, kind: str, spread: Spread, on_step: Callable[[], None]) -> Tuned:
    """Tune one task on one person. `on_step` is called after each derivative, or each value of a sweep."""
    case = Case(number, task, kind, BEGINNINGS[way])
    if way == "hidden":
        return _without_reference(case, spread, on_step)
    start = BASES[way]

    def run(batch: Sequence[FilterSettings]) -> list[np.ndarray]:
        return list(spread(residuals_of, [(case, settings) for settings in batch]))

    optimum = tuned_against_reference([recording_of(case)], start, (), SEARCH, run, on_step)
    costs = [float(np.degrees(np.sqrt(np.mean(np.square(error))))) for error in run([start, optimum])]
    return Tuned(way, task, start, optimum, "deg RMS", *costs)


def _without_reference(case: Case, spread: Spread, on_step: Callable[[], None]) -> Tuned:
    start = from_still_part(recording_of(case)._replace(angles=None), STANDING_FRAMES)

    def judge(batch: Sequence[FilterSettings]) -> list[float]:
        work = [(case, settings, seed) for settings in batch for seed in HIDDEN_SEEDS]
        found = np.array(list(spread(log_misfit_of, work))).reshape(len(batch), -1)
        return [float(value) for value in found.mean(axis=1)]

    optimum = tuned_by_hidden_centres([], start, SWEEPS, judge=judge, on_step=on_step)
    costs = [float(1e3 * np.exp(value / 2.0)) for value in judge([start, optimum])]
    return Tuned("hidden", case.task, start, optimum, "mm RMS", *costs)


def cells_for(
    settings: Callable[[int], FilterSettings], beginning: Beginning, kind: str, people: Iterable[int],
    tasks: Iterable[int], spread: Spread,
) -> list[Cell]:  # fmt: skip
    """Mean cells over people; the settings may differ with the task."""
    work = [(Case(number, task, kind, beginning), settings(task)) for task in tasks for number in people]
    return mean_cells(list(spread(cells_of_case, work)))


def table_text(on: str, tables: dict[Way, dict[int, Values]]) -> str:
    """The module `tuned_tables`."""
    lines = [
        '"""Written by `ambula tune --out`; not edited by hand.', "",
        "Camera variance (m^2), along bones (squared bones), the groups of parameters.GROUPS; per task of the paper.",
        '"""', "", f'TUNED_ON = "{on}"', "", "TABLES: dict[str, dict[int, tuple[float, ...]]] = {",
    ]  # fmt: skip
    for way, tasks in tables.items():
        lines.append(f'    "{way}": {{')
        for task, values in tasks.items():
            lines.append(f"        {task}: ({', '.join(f'{value:.3g}' for value in values)}),")
        lines.append("    },")
    return "\n".join([*lines, "}  # fmt: skip", ""])
