"""The phase that goes on, and how phases are told."""

import math
from dataclasses import asdict, dataclass

from schemas.tasks import TaskPhase
from schemas.vocabulary import Task, TaskPhaseKind
from services.flow.node import State
from services.segmentation.timed_up_and_go.turns import Boundary
from services.segmentation.walking_tests.step_trail import StepTrail


@dataclass
class BookState:
    """Everything that changes."""

    attempt: int = 0
    phase: str | None = None
    start_ns: int = 0
    start_std_s: float = 0.0
    walked_m: float | None = None  # at its start
    variance_m2: float = 0.0
    steps: int = 0


class PhaseBook:
    """Opens and closes one phase after another, with what was walked in each."""

    def __init__(self, task: Task, trail: StepTrail, length_std_share: float, *, sees_both: bool) -> None:
        """`sees_both`: the steps of both legs are told."""
        self._task, self._trail, self._share, self._sees_both = task, trail, length_std_share, sees_both
        self.state = BookState()

    @property
    def phase(self) -> TaskPhaseKind | None:
        """What goes on."""
        return None if self.state.phase is None else TaskPhaseKind(self.state.phase)

    def begin(self, kind: TaskPhaseKind, start: Boundary) -> TaskPhase:
        """A phase begins."""
        walked = self._trail.walked(start.at_ns)
        state = self.state
        state.phase, state.start_ns, state.start_std_s = kind.value, start.at_ns, start.std_s
        state.walked_m, state.variance_m2 = (0.0, 0.0) if walked is None else walked
        state.steps = self._trail.steps(start.at_ns)
        return self.told(kind, start, None)

    def end(self, at_ns: int, std_s: float | None) -> TaskPhase:
        """The phase that goes on ends; without a deviation it was given up."""
        state, kind = self.state, self.phase
        assert kind is not None
        at_ns = max(at_ns, state.start_ns)
        walked = self._trail.walked(at_ns)
        distance_m, variance = None, 0.0
        if walked is not None:
            distance_m = max(0.0, walked[0] - (state.walked_m or 0.0))
            variance = max(0.0, walked[1] - state.variance_m2) + (self._share * distance_m) ** 2
        state.phase = None
        start = Boundary(state.start_ns, state.start_std_s)
        steps = self._trail.steps(at_ns) - state.steps if self._sees_both else None
        told = self.told(kind, start, Boundary(at_ns, std_s or 0.0), distance_m, math.sqrt(variance), steps)
        return told if std_s is not None else told.model_copy(update={"end_std_s": None})

    def next(self, kind: TaskPhaseKind, at: Boundary) -> list[TaskPhase]:
        """The phase that goes on ends where the next begins."""
        at = Boundary(max(at.at_ns, self.state.start_ns), at.std_s)
        return [self.end(*at), self.begin(kind, at)]

    def told(
        self,
        kind: TaskPhaseKind,
        start: Boundary,
        end: Boundary | None,
        distance_m: float | None = None,
        distance_std_m: float = 0.0,
        steps: int | None = None,
        speed_change: float | None = None,
    ) -> TaskPhase:
        """A message of this attempt."""
        return TaskPhase(
            task=self._task,
            attempt=self.state.attempt,
            phase=kind,
            start_ns=start.at_ns,
            start_std_s=start.std_s,
            end_ns=None if end is None else end.at_ns,
            end_std_s=None if end is None else end.std_s,
            largest_turn_rate=None,
            largest_thigh_rate=None,
            steps=steps,
            distance_m=distance_m,
            distance_std_m=None if distance_m is None else distance_std_m,
            speed_change=speed_change,
        )

    def snapshot(self) -> State:
        """The state as JSON values."""
        return asdict(self.state)

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.state = BookState(**state)
