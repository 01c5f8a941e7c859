"""Found repetitions against true ones."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from schemas.tasks import Repetition
from services.bench.repetitions.exercises import Truth
from services.segmentation.repetitions.movement_watch import range_of

WITHIN = 0.1
"""Share of a repetition by which its start and end may be off to be cut right, as in the published segmentation."""


@dataclass
class Tally:
    """Sums over sessions."""

    true: int = 0
    missed: int = 0
    extra: int = 0
    partial: int = 0
    partial_counted: int = 0
    cut_right: int = 0
    range_errors: list[float] = field(default_factory=list)  # rad
    start_errors: list[float] = field(default_factory=list)  # s
    turn_errors: list[float] = field(default_factory=list)  # s
    end_errors: list[float] = field(default_factory=list)  # s

    def add(self, found: Sequence[Repetition], truths: Sequence[Truth]) -> None:
        """Compare the repetitions that count with those that were made.

        A repetition is found when exactly one that counts turns within it. Whatever else counts is extra.
        """
        counted = [one for one in found if one.valid]
        for truth in truths:
            inside = [one for one in counted if truth.start_s <= one.turn_ns / 1e9 <= truth.end_s]
            if truth.is_partial:
                self.partial += 1
                self.partial_counted += bool(inside)
                continue
            self.true += 1
            if not inside:
                self.missed += 1
                continue
            self.extra += len(inside) - 1
            self._errors(inside[0], truth)
        within = [any(t.start_s <= one.turn_ns / 1e9 <= t.end_s for t in truths) for one in counted]
        self.extra += within.count(False)

    def _errors(self, one: Repetition, truth: Truth) -> None:
        self.range_errors.append(range_of(one) - truth.reach)
        errors = one.start_ns / 1e9 - truth.start_s, one.end_ns / 1e9 - truth.end_s
        self.start_errors.append(errors[0])
        self.turn_errors.append(one.turn_ns / 1e9 - truth.turn_s)
        self.end_errors.append(errors[1])
        self.cut_right += max(map(abs, errors)) <= WITHIN * (truth.end_s - truth.start_s)

    @property
    def wrong_percent(self) -> float:
        """Missed and extra ones, per hundred true ones."""
        return 100.0 * (self.missed + self.extra) / max(self.true, 1)

    @property
    def right_percent(self) -> float:
        """Those whose start and end are both within WITHIN of a repetition."""
        return 100.0 * self.cut_right / max(self.true, 1)


def mean_absolute(errors: Sequence[float]) -> float:
    """NaN without any."""
    return float(np.mean(np.abs(errors))) if len(errors) else float("nan")


def true_phase(time_s: NDArray[np.float64], truths: Sequence[Truth]) -> NDArray[np.float64]:
    """A phase that makes a turn from the start of each repetition to the start of the next, rad."""
    starts = [truth.start_s for truth in truths] + [truths[-1].end_s]
    return np.asarray(np.interp(time_s, starts, 2 * np.pi * np.arange(len(starts))))
