"""Walks, turns and rests of a walk for time."""

from schemas.tasks import TaskPhase
from schemas.vocabulary import Task, TaskPhaseKind
from services.flow.node import State
from services.segmentation.timed_up_and_go.turns import Boundary
from services.segmentation.walking_tests.parameters import WalkingTestParameters
from services.segmentation.walking_tests.phase_book import PhaseBook
from services.segmentation.walking_tests.sight import Sight, set_out, stopped, turn_watch
from services.segmentation.walking_tests.step_trail import StepTrail

DURATION_S = 360.0
"""Where nobody said another one (ATS 2002)."""
_WALK, _TURN, _REST = TaskPhaseKind.WALK, TaskPhaseKind.TURN, TaskPhaseKind.REST


class SixMinutes:
    """The clock starts with the first step and runs on in rests; whatever comes after the time does not count."""

    def __init__(
        self, parameters: WalkingTestParameters, trail: StepTrail, duration_s: float | None, *, sees_both: bool
    ) -> None:
        self._parameters = parameters
        self._duration_ns = round((duration_s or DURATION_S) * 1e9)
        self._book = PhaseBook(Task.SIX_MINUTE_WALK, trail, parameters.length_std_share, sees_both=sees_both)
        self.turns = turn_watch()
        self._start: Boundary | None = None
        self._over = False

    def look(self, sight: Sight) -> list[TaskPhase]:
        """What the newest instant leads to."""
        if self._over:
            return []
        if self._start is None:
            return self._begin(sight)
        limit_ns = self._start.at_ns + self._duration_ns
        if sight.now_ns > limit_ns + self._parameters.recognised_s * 1e9:
            self._over = True
            return [self._book.end(limit_ns, self._start.std_s)]
        # What is recognised late but lies beyond the time is not told: the last phase ends with the time.
        return [] if self._book.state.start_ns > limit_ns else self._go_on(sight, limit_ns)

    def _begin(self, sight: Sight) -> list[TaskPhase]:
        p = self._parameters
        if sight.stands or sight.trail.state.row < p.begin_steps:
            return []
        self._start = start = set_out(sight.trail, p)
        trace = sight.trace
        at = min(trace.index_of(start.at_ns), len(trace.instants) - 1)
        self.turns.start(start.at_ns, trace.instants[at].heading)
        return [self._book.begin(_WALK, start)]

    def _go_on(self, sight: Sight, limit_ns: int) -> list[TaskPhase]:
        if self._book.phase is _TURN:
            return self._turning(sight, limit_ns)
        begun = self.turns.begun(sight.trace, self._parameters.turn_begins)
        if begun is not None:
            return self._next(_TURN, begun, limit_ns)
        if self._book.phase is _WALK and sight.stands:
            return self._next(_REST, stopped(sight.trail, self._parameters), limit_ns)
        if self._book.phase is _REST and not sight.stands:
            return self._next(_WALK, set_out(sight.trail, self._parameters), limit_ns)
        return []

    def _turning(self, sight: Sight, limit_ns: int) -> list[TaskPhase]:
        ended = self.turns.ended(sight.trace)
        if ended is not None:
            return self._next(_WALK, ended, limit_ns)
        split = self.turns.split(sight.trace, self._parameters.turn_begins)
        if split is None:
            return []
        return [*self._next(_WALK, split[0], limit_ns), *self._next(_TURN, split[1], limit_ns)]

    def _next(self, kind: TaskPhaseKind, at: Boundary, limit_ns: int) -> list[TaskPhase]:
        return [] if at.at_ns > limit_ns else self._book.next(kind, at)

    def finish(self, now_ns: int) -> list[TaskPhase]:
        """The session ends: at the time, or before it."""
        if self._over or self._start is None:
            return []
        self._over = True
        limit_ns = self._start.at_ns + self._duration_ns
        return [self._book.end(min(now_ns, limit_ns), self._start.std_s if now_ns >= limit_ns else None)]

    def snapshot(self) -> State:
        """Everything that changes."""
        start = None if self._start is None else list(self._start)
        return {"book": self._book.snapshot(), "turns": self.turns.snapshot(), "start": start, "over": self._over}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._book.restore(state["book"])
        self.turns.restore(state["turns"])
        self._start = None if state["start"] is None else Boundary(*state["start"])
        self._over = state["over"]
