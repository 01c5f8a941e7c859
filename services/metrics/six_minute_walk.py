"""What a walk for time amounts to, so far and at its end."""

import math
from collections.abc import Iterable

from schemas.metrics import Metric
from schemas.session import SessionDescription
from schemas.tasks import TaskPhase
from schemas.vocabulary import TaskPhaseKind
from services.definitions.definition import Definition
from services.definitions.walking_tests import (
    SIX_BY_LAPS,
    SIX_BY_STRIDES,
    SIX_DISTANCE,
    SIX_LAPS,
    SIX_MINUTE_SPEEDS,
    SIX_REST_TIME,
    SIX_RESTS,
    SIX_SLOPE,
    SIX_SPEED,
    SIX_TIME,
    SIX_TURN_TIME,
    SIX_TURNS,
)
from services.flow.node import State
from services.metrics import summary
from services.metrics.intervals import Interval, of_mean
from services.metrics.moments import Moments
from services.metrics.parameters import MetricsParameters
from services.metrics.phase_list import NO_HEADING, NO_STEP_LENGTHS, PhaseList, sees_heading, sees_step_lengths
from services.metrics.six_minute_distance import Distance, Walked, parts_of
from services.metrics.trend import Trend
from services.metrics.walking_parameters import WALKING_TESTS

DURATION_S = 360.0
NOT_BEGUN = "no walking seen"
NO_CORRIDOR = "the length of the corridor is not known"
NO_END_REACHED = "no end of the corridor was reached"
MINUTE_S = 60.0


class SixMinuteTotals:
    """Computed anew from the phases of the test, of which there are no more than a message takes."""

    def __init__(self, description: SessionDescription, parameters: MetricsParameters) -> None:
        self._corridor_m = description.walkway_m
        self._duration_s = description.conditions.test_duration_s or DURATION_S
        self._sees_steps, self._sees_heading = sees_step_lengths(description), sees_heading(description)
        self._list = PhaseList(lambda phase: (phase.phase, phase.start_ns), parameters.most_phases)

    @property
    def phases(self) -> list[TaskPhase]:
        """In order, each as it was last told."""
        return self._list.phases

    def add(self, phase: TaskPhase) -> bool:
        """Take a message of a phase. Whether it ended one."""
        self._list.add(phase)
        return phase.end_ns is not None

    def metrics(self, *, final: bool) -> list[Metric]:
        """Every row of the table, in its order."""
        walked = Walked(parts_of(self.phases), self._corridor_m if self._sees_heading else None)
        time_s = walked.parts[-1].end_s if walked.parts else 0.0
        short = final and time_s < self._duration_s - WALKING_TESTS.test_time_tolerance_s
        cut = f"seen for {time_s:.0f} s of {self._duration_s:.0f} s" if short and walked.parts else None
        return [
            *self._distances(walked, time_s, cut),
            *self._minutes(walked, time_s),
            self._slope(walked),
            *self._turns(walked),
            *self._rests(walked),
            self._count_or_not(SIX_TIME, walked, time_s, None),
        ]

    def _distances(self, walked: Walked, time_s: float, cut: str | None) -> list[Metric]:
        strides = walked.by_strides()
        no_steps = NO_STEP_LENGTHS if not self._sees_steps else NOT_BEGUN
        both = walked.combined()
        speed = None if both is None or time_s <= 0 else Distance(both.value_m / time_s, both.std_m / time_s)
        return [
            _told(SIX_DISTANCE, both, cut or no_steps, cut is not None),
            _told(SIX_BY_LAPS, walked.by_laps(), cut or self._no_laps(walked), cut is not None),
            _told(SIX_BY_STRIDES, strides, cut or no_steps, cut is not None),
            _told(SIX_SPEED, speed, no_steps, withhold=False),
        ]

    def _no_laps(self, walked: Walked) -> str:
        if not self._sees_heading:
            return NO_HEADING
        if self._corridor_m is None:
            return NO_CORRIDOR
        scale = walked.scale()
        if scale is not None and not walked.fits():
            return f"steps make {self._corridor_m / scale:.1f} m of what was said to be {self._corridor_m:.1f} m"
        odd = walked.odd_length()
        if odd is not None:
            return f"a length differs by {100 * odd:.0f} % from the others: a turn was missed, or made on the way"
        return NO_END_REACHED if walked.parts else NOT_BEGUN

    def _minutes(self, walked: Walked, time_s: float) -> Iterable[Metric]:
        total = walked.combined()
        share = 0.0 if total is None or total.value_m <= 0 else total.std_m / total.value_m
        share, place_m = max(share, WALKING_TESTS.scaled_step_share), math.sqrt(2) * WALKING_TESTS.stopping_place_m
        for k, definition in enumerate(SIX_MINUTE_SPEEDS):
            from_s, to_s = k * MINUTE_S, (k + 1) * MINUTE_S
            if to_s > self._duration_s + WALKING_TESTS.test_time_tolerance_s:
                return
            begun, done = walked.until(from_s), walked.until(to_s)
            if to_s > time_s + WALKING_TESTS.test_time_tolerance_s:
                yield summary.withheld(definition, None, 0, "this minute was not seen to its end")
            elif begun is None or done is None:
                yield summary.withheld(definition, None, 0, NO_STEP_LENGTHS)
            else:
                speed = (done - begun) / MINUTE_S
                std = math.hypot(speed * share, place_m / MINUTE_S)
                yield summary.shown(definition, None, speed, None, std, 1, _known(speed, std))

    def _slope(self, walked: Walked) -> Metric:
        """m/s per minute, over lengths from turn to turn: the first and the last one hold a start and a stop."""
        trend, lengths = Trend(), walked.lengths()
        for at_s, speed in lengths:
            trend.add(at_s / MINUTE_S, speed)
        found = trend.slope()
        if found is None:
            because = NO_HEADING if not self._sees_heading else NO_STEP_LENGTHS if not self._sees_steps else None
            fewer = f"{len(lengths)} of at least 3 lengths walked from turn to turn"
            return summary.withheld(SIX_SLOPE, None, len(lengths), because or fewer)
        interval = of_mean(*found, trend.count - 2)
        return summary.shown(SIX_SLOPE, None, found[0], None, found[1], trend.count, interval)

    def _turns(self, walked: Walked) -> list[Metric]:
        if not self._sees_heading:
            return [summary.withheld(each, None, 0, NO_HEADING) for each in (SIX_TURNS, SIX_TURN_TIME, SIX_LAPS)]
        turns, times = walked.turns, Moments.empty()
        for turn in turns:
            times.add(turn.lasts_s)
        return [
            self._count_or_not(SIX_TURNS, walked, float(len(turns)), len(turns)),
            summary.mean_metric(SIX_TURN_TIME, None, times, 2, "turns"),
            self._count_or_not(SIX_LAPS, walked, float(len(turns) // 2), len(turns) // 2),
        ]

    def _rests(self, walked: Walked) -> list[Metric]:
        rests = [part for part in walked.parts if part.kind is TaskPhaseKind.REST]
        rested_s = sum(rest.lasts_s for rest in rests)
        return [
            self._count_or_not(SIX_RESTS, walked, float(len(rests)), len(rests)),
            self._count_or_not(SIX_REST_TIME, walked, rested_s, len(rests)),
        ]

    @staticmethod
    def _count_or_not(definition: Definition, walked: Walked, value: float, count: int | None) -> Metric:
        if not walked.parts:
            return summary.withheld(definition, None, 0, NOT_BEGUN)
        return summary.shown(definition, None, value, None, None, len(walked.parts) if count is None else count)

    def snapshot(self) -> State:
        """The phases."""
        return self._list.snapshot()

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._list.restore(state)


def _told(definition: Definition, distance: Distance | None, because: str, withhold: bool) -> Metric:
    if distance is None or withhold:
        return summary.withheld(definition, None, 0, because)
    return summary.shown(definition, None, distance.value_m, None, distance.std_m, 1, _known(*distance))


def _known(value: float, std: float) -> Interval:
    """Of something that was measured once, with a known deviation."""
    return of_mean(value, 0.0, 1, std)
