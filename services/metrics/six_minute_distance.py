"""How far somebody walked in a corridor: by steps, by its lengths, and by both together."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from statistics import median
from typing import NamedTuple

from schemas.tasks import TaskPhase
from schemas.vocabulary import TaskPhaseKind
from services.metrics.walking_parameters import WALKING_TESTS, WalkingTestMetricsParameters


class Distance(NamedTuple):
    """m, with one standard deviation."""

    value_m: float
    std_m: float


class Part(NamedTuple):
    """A phase that has ended, s since the first step."""

    kind: TaskPhaseKind
    start_s: float
    end_s: float
    walked_m: float | None
    std_m: float

    @property
    def lasts_s(self) -> float:
        """s."""
        return self.end_s - self.start_s


def parts_of(phases: Sequence[TaskPhase]) -> list[Part]:
    """The phases that have ended, on the clock of the test."""
    if not phases:
        return []
    zero_ns = phases[0].start_ns
    return [
        Part(
            phase.phase,
            (phase.start_ns - zero_ns) * 1e-9,
            (phase.end_ns - zero_ns) * 1e-9,
            phase.distance_m,
            phase.distance_std_m or 0.0,
        )
        for phase in phases
        if phase.end_ns is not None
    ]


@dataclass(frozen=True)
class Walked:
    """What was walked so far, in a corridor of known length or an unknown one."""

    parts: Sequence[Part]
    corridor_m: float | None
    parameters: WalkingTestMetricsParameters = WALKING_TESTS

    @property
    def turns(self) -> list[Part]:
        """At the ends of the corridor."""
        return [part for part in self.parts if part.kind is TaskPhaseKind.TURN]

    def by_strides(self) -> Distance | None:
        """Sum of the steps.

        What the steps of walks have in common as an error adds up, so their deviations do; those of turns, where steps
        are seen less well, are each by itself.
        """
        known = [part for part in self.parts if part.walked_m is not None]
        if not known or len(known) < len(self.parts):
            return None
        common_m = sum(part.std_m for part in known if part.kind is not TaskPhaseKind.TURN)
        turning_m = math.hypot(*(part.std_m for part in known if part.kind is TaskPhaseKind.TURN))
        return Distance(sum(part.walked_m or 0.0 for part in known), math.hypot(common_m, turning_m))

    def scale(self) -> float | None:
        """What makes the steps from the start to the last turn as long as the lengths of the corridor."""
        walked_m, turns = self._before_last_turn(), len(self.turns)
        if self.corridor_m is None or not walked_m or not turns:
            return None
        return turns * self.corridor_m / walked_m

    def fits(self) -> bool:
        """Whether steps and corridor can be of the same walk."""
        scale = self.scale()
        return scale is None or abs(scale - 1) <= self.parameters.most_corridor_misfit

    def odd_length(self) -> float | None:
        """The share of the median by which a length differs so much that a turn was missed, or made on the way.

        By their steps; where those have no length, by the time they took.
        """
        lengths = self._lengths_by(lambda part: part.walked_m)
        most = self.parameters.most_length_misfit
        if lengths is None:
            lengths = self._lengths_by(lambda part: 0.0 if part.kind is TaskPhaseKind.REST else part.lasts_s)
            most = self.parameters.most_time_misfit
        usual = median(lengths) if lengths else 0.0
        odd = max((abs(length / usual - 1) for length in lengths or ()), default=0.0) if usual else 0.0
        return odd if odd > most else None

    def _lengths_by(self, measure: Callable[[Part], float | None]) -> list[float] | None:
        """Of each length up to the last turn; half of a turn belongs to either. None where a part is not known."""
        sums = [0.0]
        for part in self.parts:
            value = measure(part)
            if value is None:
                return None
            if part.kind is TaskPhaseKind.TURN:
                sums[-1] += value / 2
                sums.append(value / 2)
            else:
                sums[-1] += value
        return sums[:-1]

    def by_laps(self) -> Distance | None:
        """Whole lengths and what was walked after half of the last turn; None before the first."""
        if self.corridor_m is None or not self.turns or not self.fits() or self.odd_length() is not None:
            return None
        scale, strides = self.scale(), self.by_strides()
        if scale is not None and strides is not None:
            rest_m = scale * (strides.value_m - (self._before_last_turn() or 0.0))
            share = self.parameters.scaled_step_share
        else:
            rest_m, share = self._rest_by_time(self.corridor_m), self.parameters.timed_rest_share
        place_m = self.parameters.stopping_place_m
        return Distance(len(self.turns) * self.corridor_m + rest_m, math.hypot(share * rest_m, place_m))

    def combined(self) -> Distance | None:
        """Both, weighted by 1 / variance. Where they contradict each other, the deviation says so.

        chi^2 = (a - b)^2 / (s_a^2 + s_b^2); above 1 the deviation is larger by sqrt(chi^2) (Birge 1932).
        """
        laps, strides = self.by_laps(), self.by_strides()
        if laps is None or strides is None:
            return strides if laps is None else laps
        a, b = laps.std_m**2, strides.std_m**2
        value = (laps.value_m * b + strides.value_m * a) / (a + b)
        chi = (laps.value_m - strides.value_m) ** 2 / (a + b)
        return Distance(value, math.sqrt(a * b / (a + b) * max(1.0, chi)))

    def until(self, at_s: float) -> float | None:
        """m by the clock of the test, steps scaled to the corridor where that is known; even speed within a part."""
        fitting = self._believed_scale()
        total = 0.0
        for part in self.parts:
            if part.start_s >= at_s:
                break
            if part.walked_m is None:
                return None
            share = min(1.0, (at_s - part.start_s) / part.lasts_s) if part.lasts_s > 0 else 1.0
            total += share * part.walked_m
        return total * fitting

    def lengths(self) -> list[tuple[float, float]]:
        """Walks from turn to turn: s at the middle, and speed m/s."""
        found = []
        fitting = self._believed_scale()
        kinds = [part.kind for part in self.parts]
        for i in range(1, len(self.parts) - 1):
            part = self.parts[i]
            whole = (kinds[i - 1], kinds[i], kinds[i + 1]) == (
                TaskPhaseKind.TURN, TaskPhaseKind.WALK, TaskPhaseKind.TURN
            )  # fmt: skip
            if whole and part.walked_m is not None and part.lasts_s > self.parameters.shortest_length_s:
                found.append(((part.start_s + part.end_s) / 2, fitting * part.walked_m / part.lasts_s))
        return found

    def _believed_scale(self) -> float:
        return (self.scale() or 1.0) if self.fits() and self.odd_length() is None else 1.0

    def _before_last_turn(self) -> float | None:
        """m of steps up to the middle of the last turn."""
        last = max((i for i, part in enumerate(self.parts) if part.kind is TaskPhaseKind.TURN), default=None)
        if last is None or any(part.walked_m is None for part in self.parts):
            return None
        return sum(part.walked_m or 0.0 for part in self.parts[:last]) + (self.parts[last].walked_m or 0.0) / 2

    def _rest_by_time(self, corridor_m: float) -> float:
        """m of the last length by the time it took, at the pace of the others."""
        middles = [0.0, *((turn.start_s + turn.end_s) / 2 for turn in self.turns)]
        resting = [part for part in self.parts if part.kind is TaskPhaseKind.REST]

        def walked_s(from_s: float, to_s: float) -> float:
            return to_s - from_s - sum(max(0.0, min(rest.end_s, to_s) - max(rest.start_s, from_s)) for rest in resting)

        pace_s = [walked_s(*span) for span in pairwise(middles)]
        since_s = walked_s(middles[-1], max(middles[-1], self.parts[-1].end_s))
        return min(corridor_m, corridor_m * since_s / (sum(pace_s) / len(pace_s)))
