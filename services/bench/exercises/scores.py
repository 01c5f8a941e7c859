"""Found repetitions against true ones."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from schemas.tasks import Repetition
from schemas.vocabulary import Side
from services.bench.exercises.truths import TrueRepetition
from services.segmentation.repetitions.movement_watch import range_of

SLACK_S = 0.3
"""s beyond its ends in which a repetition may turn and still be found."""


@dataclass
class Tally:
    """Sums over sessions. Errors are found minus true: rad, s, and of ratios of the sides."""

    true: int = 0
    missed: int = 0
    extra: int = 0
    partial: int = 0
    partial_counted: int = 0
    ranges: list[float] = field(default_factory=list)
    starts: list[float] = field(default_factory=list)
    ends: list[float] = field(default_factory=list)
    holds: list[float] = field(default_factory=list)
    knees: list[float] = field(default_factory=list)
    knees_asked: int = 0
    symmetries: list[float] = field(default_factory=list)

    @property
    def wrong_percent(self) -> float:
        """Missed and extra ones, per hundred true ones."""
        return 100.0 * (self.missed + self.extra) / max(self.true, 1)

    def add(self, found: Sequence[Repetition], truths: Sequence[TrueRepetition]) -> None:
        """Compare a session's repetitions that count with those that were made in full.

        A repetition is found when one of its side that counts turns within it. Whatever else counts is extra.
        """
        counted, used = [one for one in found if one.valid], set[int]()
        pairs: list[tuple[Repetition, TrueRepetition]] = []
        for truth in truths:
            inside = [k for k, one in enumerate(counted) if k not in used and _turns_within(one, truth)]
            used |= set(inside[:1])
            if truth.is_partial:
                self.partial += 1
                self.partial_counted += bool(inside)
                continue
            self.true += 1
            self.missed += not inside
            if inside:
                pairs.append((counted[inside[0]], truth))
        self.extra += len(counted) - len(used)
        for one, truth in pairs:
            self._errors(one, truth)
        self._symmetry(pairs)

    def _errors(self, one: Repetition, truth: TrueRepetition) -> None:
        self.ranges.append(range_of(one) - truth.reach)
        self.starts.append(one.start_ns / 1e9 - truth.start_s)
        self.ends.append(one.end_ns / 1e9 - truth.end_s)
        if one.hold_s is not None:
            self.holds.append(one.hold_s - truth.hold_s)
        for side in Side:
            name = f"knee_flexion_{side}"
            if one.side in (None, side):
                self.knees_asked += 1
                self.knees += [one.ranges[name] - truth.joints[name]] if name in one.ranges else []

    def _symmetry(self, pairs: Sequence[tuple[Repetition, TrueRepetition]]) -> None:
        """Larger / smaller side: of the movement where it has sides, of the knees where it has none."""
        if not pairs:
            return
        by_side: dict[Side, tuple[list[float], list[float]]] = {side: ([], []) for side in Side}
        for one, truth in pairs:
            for side in Side:
                name = f"knee_flexion_{side}"
                if one.side is side:
                    by_side[side][0].append(range_of(one))
                    by_side[side][1].append(truth.reach)
                elif one.side is None and name in one.ranges:
                    by_side[side][0].append(one.ranges[name])
                    by_side[side][1].append(truth.joints[name])
        if all(found for found, _ in by_side.values()):
            found, true = (
                float(np.mean(by_side[Side.RIGHT][which]) / np.mean(by_side[Side.LEFT][which])) for which in (0, 1)
            )
            self.symmetries.append(found - true)


def _turns_within(one: Repetition, truth: TrueRepetition) -> bool:
    return one.side is truth.side and truth.start_s - SLACK_S <= one.turn_ns / 1e9 <= truth.end_s + SLACK_S


def mean_absolute(errors: Sequence[float]) -> float:
    """NaN without any."""
    return float(np.mean(np.abs(errors))) if len(errors) else float("nan")


def mean(errors: Sequence[float]) -> float:
    """NaN without any."""
    return float(np.mean(errors)) if len(errors) else float("nan")
