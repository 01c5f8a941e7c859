"""What the trials of a ten-metre walk amount to."""

import math
from collections.abc import Iterable

from schemas.metrics import Metric
from schemas.session import SessionDescription
from schemas.tasks import TaskPhase
from schemas.vocabulary import TaskPhaseKind
from services.definitions.definition import Definition
from services.definitions.walking_tests import (
    TEN_ABORTED,
    TEN_CHANGE,
    TEN_SPEED,
    TEN_STEADY,
    TEN_STRIDES,
    TEN_TIME,
    TEN_TRIALS,
)
from services.flow.node import State
from services.metrics import summary
from services.metrics.intervals import of_mean
from services.metrics.moments import Moments
from services.metrics.parameters import MetricsParameters
from services.metrics.phase_list import NO_STEP_LENGTHS, PhaseList, sees_step_lengths
from services.metrics.walking_parameters import WALKING_TESTS

NO_TRIAL = "no completed trial"
NOT_OBSERVED = "not observed in any completed trial"
Value = tuple[float, float]
"""Of one trial, with its deviation."""


class TenMetreTotals:
    """The mean over the trials whose timed zone was walked to its end."""

    def __init__(self, description: SessionDescription, parameters: MetricsParameters) -> None:
        self._sees_steps = sees_step_lengths(description)
        self._list = PhaseList(lambda phase: (phase.attempt, phase.phase), parameters.most_phases)

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
        zones = [zone for phase in self.phases if (zone := _timed(phase)) is not None]
        attempts = {phase.attempt for phase in self.phases}
        goes_on = bool(self.phases) and not final and self.phases[-1].end_ns is None
        done = {zone.attempt for zone in zones}
        aborted = len(attempts - done - ({self.phases[-1].attempt} if goes_on else set()))
        changes = [zone.speed_change for zone in zones if zone.speed_change is not None]
        steady = sum(abs(zone.speed_change or 0.0) <= _steady_within(zone) for zone in zones)
        return [
            self._mean(TEN_SPEED, [_speed(zone) for zone in zones], len(zones)),
            self._mean(TEN_TIME, [_time(zone) for zone in zones], len(zones)),
            self._mean(TEN_STRIDES, [(zone.steps / 2, 0.5) for zone in zones if zone.steps is not None], len(zones)),
            self._mean(TEN_CHANGE, [(change, 0.0) for change in changes], len(zones)),
            summary.shown(TEN_STEADY, None, float(steady), None, None, len(changes))
            if changes
            else summary.withheld(TEN_STEADY, None, 0, NOT_OBSERVED if zones else self._no_trial),
            summary.shown(TEN_TRIALS, None, float(len(zones)), None, None, len(zones)),
            summary.shown(TEN_ABORTED, None, float(aborted), None, None, aborted),
        ]

    @property
    def _no_trial(self) -> str:
        return NO_TRIAL if self._sees_steps else NO_STEP_LENGTHS

    def _mean(self, definition: Definition, values: Iterable[Value], trials: int) -> Metric:
        """Mean; error sqrt(spread^2 / n + mean variance of a trial).

        Whoever starts at the same line steps alike in every trial, so what a line errs by does not average out.
        """
        moments, variances = Moments.empty(), Moments.empty()
        for value, std in values:
            moments.add(value)
            variances.add(std**2)
        if moments.count == 0:
            return summary.withheld(definition, None, 0, NOT_OBSERVED if trials else self._no_trial)
        spread = moments.spread()
        scatter = 0.0 if spread is None else float(spread) ** 2
        told, value, n = None if spread is None else float(spread), float(moments.mean), moments.count
        error = math.sqrt(scatter / n + float(variances.mean))
        interval = of_mean(value, math.sqrt(scatter / n), n - 1, math.sqrt(float(variances.mean)))
        return summary.shown(definition, None, value, told, error or None, n, interval if error else None)

    def snapshot(self) -> State:
        """The phases."""
        return self._list.snapshot()

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._list.restore(state)


def _timed(phase: TaskPhase) -> TaskPhase | None:
    """A timed zone that was walked to its end."""
    ended = phase.phase is TaskPhaseKind.TIMED_ZONE and phase.end_ns is not None and phase.end_std_s is not None
    return phase if ended and phase.distance_m and (phase.end_ns or 0) > phase.start_ns else None


def _time(zone: TaskPhase) -> Value:
    return ((zone.end_ns or 0) - zone.start_ns) * 1e-9, math.hypot(zone.start_std_s, zone.end_std_s or 0.0)


def _speed(zone: TaskPhase) -> Value:
    """Distance / time; the line's place is in the deviation of the time."""
    time_s, std_s = _time(zone)
    speed = (zone.distance_m or 0.0) / time_s
    return speed, speed * std_s / time_s


def _steady_within(zone: TaskPhase) -> float:
    """m/s by which both halves may differ; negative where they were not measured."""
    return -1.0 if zone.speed_change is None else WALKING_TESTS.steady_share * _speed(zone)[0]
