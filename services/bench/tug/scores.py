"""Boundaries of found attempts against the true ones."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from schemas.tasks import TaskPhase
from schemas.vocabulary import TASK_PHASES, Task
from services.bench.scoreboard import Row, at_least, at_most, informative
from services.ingest.synthetic.tug_plan import TruePhase

Array = NDArray[np.float64]

BOUNDARIES = ("first motion", "upright", "turn begins", "turn ends", "turn to sit begins", "seated")
PHASES = len(TASK_PHASES[Task.TIMED_UP_AND_GO])
SAME_ATTEMPT_S = 3.0
"""s between two beginnings that are those of one attempt."""

MOST_TOTAL_S = 0.2
MOST_BOUNDARY_S = 0.25
LEAST_WITHIN = 0.9
"""Share of boundaries within two of their own deviations: 0.95 if they are normal and known exactly."""


@dataclass
class Tally:
    """All attempts of one kind of session."""

    errors: list[list[float]] = field(default_factory=list)  # s, one row per attempt, columns as BOUNDARIES
    stds: list[list[float]] = field(default_factory=list)
    true: int = 0
    missed: int = 0
    invented: int = 0

    def add(self, truth: Sequence[TruePhase], found: dict[int, list[TaskPhase]]) -> None:
        """Take a session. Attempts that are cut short in truth may be found as such, and are not scored."""
        every: dict[int, list[TruePhase]] = {}
        for phase in truth:
            every.setdefault(phase.attempt, []).append(phase)
        left = list(found.values())
        for phases in every.values():
            match = next(
                (each for each in left if abs(each[0].start_ns * 1e-9 - phases[0].start_s) < SAME_ATTEMPT_S), None
            )
            if match is not None:
                left.remove(match)
            if len(phases) < PHASES:
                continue
            self.true += 1
            if match is None or not is_complete(match):
                self.missed += 1
                continue
            true_s = [phases[0].start_s, *(phase.end_s for phase in phases)]
            self.errors.append([at - true for at, true in zip(boundaries_s(match), true_s, strict=True)])
            self.stds.append([match[0].start_std_s, *(phase.end_std_s or 0.0 for phase in match)])
        self.invented += len(left)

    def merged(self, other: "Tally") -> "Tally":
        """Both together."""
        return Tally(
            self.errors + other.errors,
            self.stds + other.stds,
            self.true + other.true,
            self.missed + other.missed,
            self.invented + other.invented,
        )


def is_complete(phases: Sequence[TaskPhase]) -> bool:
    """All phases, and a chair at the end."""
    return len(phases) == PHASES and phases[-1].end_std_s is not None


def boundaries_s(phases: Sequence[TaskPhase]) -> list[float]:
    """The begin of the first and the end of each phase, s."""
    return [phases[0].start_ns * 1e-9, *((phase.end_ns or 0) * 1e-9 for phase in phases)]


def tally_rows(name: str, tally: Tally) -> list[Row]:
    """Attempts, total time and boundaries of one kind of session."""
    rows = [
        at_most(f"{name}: attempts missed of {tally.true}", tally.missed, "1", 0),
        at_most(f"{name}: attempts invented", tally.invented, "1", 0),
    ]
    if not tally.errors:
        return rows
    errors, stds = np.array(tally.errors), np.array(tally.stds)
    total = errors[:, -1] - errors[:, 0]
    rows += [
        at_most(f"{name}: total time, largest error", float(np.abs(total).max()), "s", MOST_TOTAL_S),
        informative(f"{name}: total time, bias", float(total.mean()), "s"),
        at_least(f"{name}: boundaries within 2 claimed deviations", _within(errors, stds), "1", LEAST_WITHIN),
    ]
    for i, boundary in enumerate(BOUNDARIES):
        error = errors[:, i]
        bias, spread = float(error.mean()), float(error.std(ddof=1)) if len(error) > 1 else 0.0
        rows += [
            at_most(f"{name}: {boundary}, |bias| + 2 SD", abs(bias) + 2 * spread, "s", MOST_BOUNDARY_S),
            informative(f"{name}: {boundary}, bias", bias, "s", detail=True),
            informative(f"{name}: {boundary}, SD", spread, "s", detail=True),
            informative(f"{name}: {boundary}, largest", float(np.abs(error).max()), "s", detail=True),
            informative(f"{name}: {boundary}, claimed deviation", float(stds[:, i].mean()), "s", detail=True),
        ]
    return rows


def _within(errors: Array, stds: Array) -> float:
    return float((np.abs(errors) <= 2 * stds).mean())
