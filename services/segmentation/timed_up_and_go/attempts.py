"""From changes of posture, steps and turns to the phases of attempts."""

from dataclasses import asdict, dataclass
from typing import Any

from schemas.tasks import TaskPhase
from schemas.vocabulary import Task, TaskPhaseKind
from services.flow.node import State
from services.segmentation.timed_up_and_go.parameters import TimedUpAndGoParameters
from services.segmentation.timed_up_and_go.posture import Change
from services.segmentation.timed_up_and_go.steps import Steps
from services.segmentation.timed_up_and_go.trace import Trace
from services.segmentation.timed_up_and_go.turns import Boundary, TurnWatch


@dataclass
class AttemptState:
    """Everything that changes."""

    number: int = 0
    rise: Change | None = None  # of the attempt, or of what may become one
    phase: TaskPhaseKind | None = None  # that goes on
    start_ns: int = 0  # of it
    start_std_s: float = 0.0


class Attempts:
    """An attempt begins when somebody who rose walks. It ends on a chair, or is given up."""

    def __init__(self, parameters: TimedUpAndGoParameters, *, sees_both: bool) -> None:
        self._parameters = parameters
        self._turns = TurnWatch(parameters)
        self.steps = Steps(parameters, sees_both=sees_both)
        self.state = AttemptState()

    def step(self, trace: Trace, change: Change | None) -> list[TaskPhase]:
        """What the newest instant leads to; `change` is one of posture that it completes."""
        if change is not None:
            return self._risen(trace, change) if change.rises else self._seated(trace, change)
        state, p, now_ns = self.state, self._parameters, trace.instants[-1].captured_ns
        if state.rise is None:
            return []
        if state.phase is None:
            return self._start_walking(now_ns)
        if now_ns - state.rise.start_ns > p.longest_attempt_s * 1e9:
            return self.give_up(now_ns)
        return self._on_the_way(trace)

    def give_up(self, captured_ns: int) -> list[TaskPhase]:
        """Close what is open where it was last seen; what has not become an attempt is forgotten."""
        state = self.state
        outputs = []
        if state.phase is not None:
            outputs.append(self._phase(captured_ns, None))
            state.number += 1
        state.rise, state.phase = None, None
        return outputs

    def _risen(self, trace: Trace, rise: Change) -> list[TaskPhase]:
        outputs = self.give_up(rise.start_ns)
        self.state.rise = rise
        self.steps.start()
        at = min(trace.index_of(rise.end_ns), len(trace.instants) - 1)
        self._turns.start(rise.end_ns, trace.instants[at].heading)
        return outputs

    def _start_walking(self, now_ns: int) -> list[TaskPhase]:
        """Rising is told once there is walking, with its own earlier times."""
        state, rise = self.state, self.state.rise
        assert rise is not None
        if now_ns - rise.end_ns > self._parameters.longest_stand_s * 1e9:
            state.rise = None
        elif self.steps.walks(rise.end_ns):
            upright = Boundary(rise.end_ns, rise.end_std_s)
            begun = self._begin(TaskPhaseKind.SIT_TO_STAND, Boundary(rise.start_ns, rise.start_std_s))
            return [*begun, *self._next(TaskPhaseKind.WALK_OUT, upright, largest_thigh_rate=rise.thigh_rate)]
        return []

    def _on_the_way(self, trace: Trace) -> list[TaskPhase]:
        state, p = self.state, self._parameters
        if state.phase is TaskPhaseKind.WALK_OUT:
            begun = self._turns.begun(trace, p.turn_begins)
            return [] if begun is None else self._next(TaskPhaseKind.TURN, begun)
        if state.phase is TaskPhaseKind.TURN:
            ended = self._turns.ended(trace)
            if ended is not None:
                return self._end_turn(trace, ended)
            split = self._turns.split(trace, p.turn_to_sit_begins)
            return [] if split is None else self._turned_twice(trace, *split)
        if state.phase is TaskPhaseKind.WALK_BACK:
            begun = self._turns.begun(trace, p.turn_to_sit_begins)
            return [] if begun is None else self._next(TaskPhaseKind.TURN_TO_SIT, begun)
        return []

    def _end_turn(self, trace: Trace, ended: Boundary) -> list[TaskPhase]:
        rate = self._turn_rate(trace, self.state.start_ns, ended.at_ns)
        return self._next(TaskPhaseKind.WALK_BACK, ended, largest_turn_rate=rate)

    def _turned_twice(self, trace: Trace, ended: Boundary, begun: Boundary) -> list[TaskPhase]:
        return [*self._end_turn(trace, ended), *self._next(TaskPhaseKind.TURN_TO_SIT, begun)]

    def _seated(self, trace: Trace, sit: Change) -> list[TaskPhase]:
        state = self.state
        if state.phase is None:
            return self.give_up(sit.start_ns)
        down = Boundary(sit.start_ns, sit.start_std_s)
        outputs: list[TaskPhase] = []
        if state.phase is TaskPhaseKind.TURN:
            split = self._turns.split(trace, 0.0)
            if split is not None and sit.start_ns - split[0].at_ns > self._parameters.least_back_s * 1e9:
                outputs += self._end_turn(trace, split[0])
        if state.phase is TaskPhaseKind.WALK_BACK:
            outputs += self._next(TaskPhaseKind.TURN_TO_SIT, down)
        end, rates = down, {}
        if state.phase is TaskPhaseKind.TURN_TO_SIT:
            end = Boundary(sit.end_ns, sit.end_std_s)
            rate = self._turn_rate(trace, state.start_ns, end.at_ns)
            rates = {"largest_turn_rate": rate, "largest_thigh_rate": sit.thigh_rate}
        outputs.append(self._phase(end.at_ns, end.std_s, **rates))
        state.number, state.rise, state.phase = state.number + 1, None, None
        return outputs

    def _begin(self, phase: TaskPhaseKind, start: Boundary) -> list[TaskPhase]:
        state = self.state
        state.phase, state.start_ns, state.start_std_s = phase, start.at_ns, start.std_s
        return [self._phase(None, None)]

    def _next(self, phase: TaskPhaseKind, boundary: Boundary, **rates: float | None) -> list[TaskPhase]:
        """End the phase that goes on and begin the next, at one boundary."""
        at = Boundary(max(boundary.at_ns, self.state.start_ns), boundary.std_s)
        return [self._phase(at.at_ns, at.std_s, **rates), *self._begin(phase, at)]

    def _phase(self, end_ns: int | None, end_std_s: float | None, **rates: float | None) -> TaskPhase:
        state = self.state
        assert state.phase is not None
        end_ns = None if end_ns is None else max(end_ns, state.start_ns)
        known: dict[str, Any] = {"largest_turn_rate": None, "largest_thigh_rate": None, **rates}
        return TaskPhase(
            task=Task.TIMED_UP_AND_GO,
            attempt=state.number,
            phase=state.phase,
            start_ns=state.start_ns,
            start_std_s=state.start_std_s,
            end_ns=end_ns,
            end_std_s=end_std_s,
            steps=None if end_ns is None else self.steps.of_both(state.start_ns, end_ns),
            distance_m=None,
            distance_std_m=None,
            speed_change=None,
            **known,
        )

    def _turn_rate(self, trace: Trace, start_ns: int, end_ns: int) -> float | None:
        """Largest rate of the heading over `turn_rate_over_s` within a span; None when it is no longer remembered."""
        first, last = trace.index_of(start_ns), trace.index_of(end_ns)
        instants = trace.instants[first : last + 1]
        if first == 0 or len(instants) < 2:
            return None
        rates = []
        newer = 0
        for older in instants:
            while newer < len(instants) and (
                instants[newer].captured_ns - older.captured_ns < self._parameters.turn_rate_over_s * 1e9
            ):
                newer += 1
            if newer == len(instants):
                break
            span_s = (instants[newer].captured_ns - older.captured_ns) * 1e-9
            rates.append(abs(instants[newer].heading - older.heading) / span_s)
        return max(rates, default=None)

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "attempt": asdict(self.state) | {"rise": None if self.state.rise is None else list(self.state.rise)},
            "turns": self._turns.snapshot(),
            "steps": self.steps.snapshot(),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        kept = dict(state["attempt"])
        rise, phase = kept.pop("rise"), kept.pop("phase")
        self.state = AttemptState(
            **kept,
            rise=None if rise is None else Change(*rise),
            phase=None if phase is None else TaskPhaseKind(phase),
        )
        self._turns.restore(state["turns"])
        self.steps.restore(state["steps"])
