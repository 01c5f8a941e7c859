"""What the phases of a timed test amount to, by task."""

from typing import Protocol

from schemas.metrics import Metric
from schemas.session import SessionDescription
from schemas.tasks import TaskPhase
from schemas.vocabulary import Task
from services.flow.node import State
from services.metrics.attempts import AttemptTotals
from services.metrics.parameters import MetricsParameters
from services.metrics.six_minute_walk import SixMinuteTotals
from services.metrics.ten_metre_walk import TenMetreTotals


class TimedTestTotals(Protocol):
    """What one kind of timed test offers the node."""

    @property
    def phases(self) -> list[TaskPhase]:
        """In order, each as it was last told, as many as a message takes."""

    def add(self, phase: TaskPhase) -> bool:
        """Take a message of a phase. Whether it ended one."""

    def metrics(self, *, final: bool) -> list[Metric]:
        """Every row of the test's table, in its order."""

    def snapshot(self) -> State:
        """Everything that changes."""

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""


def timed_test_totals(description: SessionDescription, parameters: MetricsParameters) -> TimedTestTotals | None:
    """Those of the session's task; None where it is no timed test."""
    if description.task is Task.TIMED_UP_AND_GO:
        return AttemptTotals(parameters)
    if description.task is Task.SIX_MINUTE_WALK:
        return SixMinuteTotals(description, parameters)
    return TenMetreTotals(description, parameters) if description.task is Task.TEN_METRE_WALK else None
