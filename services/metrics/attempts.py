"""What the attempts of a timed up and go amount to, and their phases one by one."""

import math
from collections.abc import Callable

from schemas.metrics import Metric
from schemas.tasks import TaskPhase
from schemas.vocabulary import TASK_PHASES, Task, TaskPhaseKind
from services.definitions.definition import Definition
from services.definitions.timed_up_and_go import TUG_ABORTED, TUG_COMPLETED, TUG_MEANS, Attempt, Measured
from services.flow.node import State
from services.metrics import summary
from services.metrics.moments import Moments
from services.metrics.parameters import MetricsParameters

PARTS = TASK_PHASES[Task.TIMED_UP_AND_GO]
NO_ATTEMPT = "no completed attempt"
NOT_OBSERVED = "not observed in any completed attempt"


class AttemptTotals:
    """Sums over the completed attempts. The size does not grow with their number beyond the phases of a message."""

    def __init__(self, parameters: MetricsParameters) -> None:
        self._parameters = parameters
        self._moments = {definition.name: Moments.empty() for definition, _ in TUG_MEANS}
        self._variances = {definition.name: Moments.empty() for definition, _ in TUG_MEANS}
        self._attempt: dict[TaskPhaseKind, TaskPhase] = {}
        self._started = self._completed = 0
        self._open = False
        self.phases: list[TaskPhase] = []
        """In order, each as it was last told, as many as a message takes."""

    def add(self, phase: TaskPhase) -> bool:
        """Take a message of a phase. Whether it ended one."""
        self._list(phase)
        if phase.attempt >= self._started:
            self._started, self._attempt, self._open = phase.attempt + 1, {}, True
        if phase.end_ns is None:
            return False
        self._attempt[phase.phase] = phase
        if phase.end_std_s is None:
            self._open = False
        elif phase.phase is TaskPhaseKind.TURN_TO_SIT and len(self._attempt) == len(PARTS):
            self._complete(self._attempt)
        return True

    def metrics(self, *, final: bool) -> list[Metric]:
        """Every row of the table, in its order."""
        aborted = self._started - self._completed - (1 if self._open and not final else 0)
        return [
            *(self._mean(definition) for definition, _ in TUG_MEANS),
            summary.shown(TUG_COMPLETED, None, float(self._completed), None, None, self._completed),
            summary.shown(TUG_ABORTED, None, float(aborted), None, None, aborted),
        ]

    def _list(self, phase: TaskPhase) -> None:
        for i in range(len(self.phases) - 1, max(-1, len(self.phases) - len(PARTS) - 1), -1):
            if (self.phases[i].attempt, self.phases[i].phase) == (phase.attempt, phase.phase):
                self.phases[i] = phase
                return
        if len(self.phases) < self._parameters.most_phases:
            self.phases.append(phase)

    def _complete(self, attempt: Attempt) -> None:
        self._completed += 1
        self._open = False
        for definition, measure in TUG_MEANS:
            self._take(definition, attempt, measure)

    def _take(self, definition: Definition, attempt: Attempt, measure: Callable[[Attempt], Measured | None]) -> None:
        measured = measure(attempt)
        if measured is not None:
            value, std = measured
            self._moments[definition.name].add(value)
            if std is not None:
                self._variances[definition.name].add(std**2)

    def _mean(self, definition: Definition) -> Metric:
        """Mean with its spread over the attempts; its error is that of the boundaries and, from two on, the scatter's.

        The error of a mean of n is sqrt((spread^2 + mean boundary variance) / n).
        """
        moments, variance = self._moments[definition.name], self._variances[definition.name]
        if moments.count == 0:
            return summary.withheld(definition, None, 0, NOT_OBSERVED if self._completed else NO_ATTEMPT)
        spread = moments.spread()
        scatter = 0.0 if spread is None else float(spread) ** 2
        known = variance.count > 0 or spread is not None
        error = math.sqrt((scatter + float(variance.mean)) / moments.count) if known else None
        return summary.shown(
            definition, None, float(moments.mean), None if spread is None else float(spread), error, moments.count
        )

    def snapshot(self) -> State:
        """Sums, the attempt that goes on, and the phases."""
        return {
            "moments": {name: moments.snapshot() for name, moments in self._moments.items()},
            "variances": {name: moments.snapshot() for name, moments in self._variances.items()},
            "attempt": [phase.model_dump(mode="json") for phase in self._attempt.values()],
            "started": self._started,
            "completed": self._completed,
            "open": self._open,
            "phases": [phase.model_dump(mode="json") for phase in self.phases],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._moments = {name: Moments.restored(kept) for name, kept in state["moments"].items()}
        self._variances = {name: Moments.restored(kept) for name, kept in state["variances"].items()}
        attempt = [TaskPhase.model_validate(kept) for kept in state["attempt"]]
        self._attempt = {phase.phase: phase for phase in attempt}
        self._started, self._completed, self._open = state["started"], state["completed"], state["open"]
        self.phases = [TaskPhase.model_validate(kept) for kept in state["phases"]]
