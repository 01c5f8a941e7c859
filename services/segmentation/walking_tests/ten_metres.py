"""Run-up, timed zone and run-out of each length of a walkway."""

from dataclasses import asdict, dataclass

from schemas.tasks import TaskPhase
from schemas.vocabulary import Task, TaskPhaseKind
from services.flow.node import State
from services.segmentation.timed_up_and_go.turns import Boundary
from services.segmentation.walking_tests.crossings import Ruler
from services.segmentation.walking_tests.parameters import WalkingTestParameters
from services.segmentation.walking_tests.phase_book import PhaseBook
from services.segmentation.walking_tests.sight import Sight, set_out, stopped, turn_watch
from services.segmentation.walking_tests.step_trail import StepTrail
from services.segmentation.walking_tests.zone import LengthStart, Zone, ZoneTimes

_RUN_UP, _ZONE, _RUN_OUT = TaskPhaseKind.RUN_UP, TaskPhaseKind.TIMED_ZONE, TaskPhaseKind.RUN_OUT


@dataclass
class LengthState:
    """Everything that changes, of the length at hand."""

    start_ns: int = 0
    start_std_s: float = 0.0
    zero_m: float = 0.0  # walked at its start
    open: bool = False  # somebody walks it
    turned: bool = False  # it began in a turn
    told: bool = False  # its run-up was
    turn_ns: int | None = None  # when the turn at its end began
    turn_std_s: float = 0.0


class TenMetres:
    """A length begins with the first step after standing, or half-way through a turn; it ends at the next of either.

    As it goes on, lines are crossed by the steps' own lengths. When it is over and the walkway is known, so is the
    scale of the steps, and its phases are told once more.
    """

    def __init__(self, parameters: WalkingTestParameters, trail: StepTrail, zone: Zone, *, sees_both: bool) -> None:
        self._parameters, self._trail, self._zone = parameters, trail, zone
        self._book = PhaseBook(Task.TEN_METRE_WALK, trail, parameters.length_std_share, sees_both=sees_both)
        self._sees_both = sees_both
        self.turns = turn_watch()
        self._length = LengthState()

    def look(self, sight: Sight) -> list[TaskPhase]:
        """What the newest instant leads to."""
        if self._length.turn_ns is not None:
            return self._turning(sight)
        if self.turns.state.straight is None and self.turns.state.since_ns == 0:
            self.turns.start(sight.now_ns, sight.trace.instants[-1].heading)
        begun = self.turns.begun(sight.trace, self._parameters.turn_begins)
        if begun is not None:
            self._length.turn_ns, self._length.turn_std_s = begun.at_ns, begun.std_s
            return []
        if sight.stands:
            return self._over(stopped(self._trail, self._parameters)) if self._length.open else []
        if not self._length.open:
            self._set_out(sight)
        return self._walking(sight) if self._length.open else []

    def _set_out(self, sight: Sight) -> None:
        if sight.trail.state.row >= self._parameters.begin_steps:
            start = set_out(sight.trail, self._parameters)
            self._open(start, turned=False)

    def _open(self, start: Boundary, *, turned: bool) -> None:
        walked = self._trail.walked(start.at_ns)
        zero_m = 0.0 if walked is None else walked[0]
        self._length = LengthState(start.at_ns, start.std_s, zero_m, open=True, turned=turned)

    def _walking(self, sight: Sight) -> list[TaskPhase]:
        length = self._length
        walked = self._trail.walked(sight.now_ns)
        if walked is None:
            return []
        outputs: list[TaskPhase] = []
        if not length.told:
            straight = self.turns.state.straight
            if walked[0] - length.zero_m < self._parameters.told_from_m or straight is None:
                return []
            length.told = True
            outputs.append(self._book.begin(_RUN_UP, Boundary(length.start_ns, length.start_std_s)))
        times = self._times(1.0, scaled=False)
        if self._book.phase is _RUN_UP and times.enters is not None:
            outputs += [self._run_up(times.enters), self._book.begin(_ZONE, times.enters)]
        if self._book.phase is _ZONE and times.leaves is not None:
            outputs += [self._timed(times), self._book.begin(_RUN_OUT, times.leaves)]
        return outputs

    def _turning(self, sight: Sight) -> list[TaskPhase]:
        """The length ends half-way through the turn, where the next begins."""
        length = self._length
        ended = self.turns.ended(sight.trace)
        split = self.turns.split(sight.trace, self._parameters.turn_begins) if ended is None else None
        if ended is None and split is None:
            return []
        over = ended if ended is not None else split[0] if split is not None else None
        assert over is not None
        assert length.turn_ns is not None
        middle_ns = (length.turn_ns + over.at_ns) // 2
        outputs = self._over(Boundary(length.turn_ns, length.turn_std_s), middle_ns) if length.open else []
        if sight.stands:
            self._length = LengthState(start_ns=middle_ns)
        else:
            self._open(Boundary(middle_ns, over.std_s), turned=True)
        if split is not None:
            self._length.turn_ns, self._length.turn_std_s = split[1].at_ns, split[1].std_s
        return outputs

    def _over(self, end: Boundary, reached_ns: int | None = None) -> list[TaskPhase]:
        """The length at hand is over. `reached_ns`: when the end of the walkway was reached, else with it."""
        length, outputs = self._length, []
        if length.told:
            walked = self._trail.walked(end.at_ns if reached_ns is None else reached_ns)
            total_m = 0.0 if walked is None else walked[0] - length.zero_m
            outputs = self._last_told(total_m, self._zone.scale(total_m), end)
            self._book.state.attempt += 1
        self._length = LengthState(start_ns=end.at_ns)
        return outputs

    def _last_told(self, total_m: float, scale: float | None, end: Boundary) -> list[TaskPhase]:
        times = self._times(scale or 1.0, scaled=scale is not None)
        if times.leaves is None and self._zone.ends_at(total_m * (scale or 1.0), scaled=scale is not None):
            times = times._replace(leaves=end)
        phase = self._book.phase
        if times.enters is None or times.leaves is None or phase is None:
            return [] if phase is None else [self._book.end(end.at_ns, None)]
        self._book.state.phase = None
        rest_m = max(0.0, total_m * (scale or 1.0) - self._zone.to_m)
        out_of = Boundary(max(end.at_ns, times.leaves.at_ns), end.std_s)
        out = self._book.told(
            _RUN_OUT,
            times.leaves,
            out_of,
            rest_m,
            self._zone.line_std_m(rest_m, scaled=scale is not None, turned=self._length.turned),
            self._steps(times.leaves, out_of),
        )
        return [self._run_up(times.enters), self._timed(times), out]

    def _run_up(self, enters: Boundary) -> TaskPhase:
        start = Boundary(self._length.start_ns, self._length.start_std_s)
        self._book.state.phase = None
        return self._book.told(_RUN_UP, start, enters, self._zone.from_m, 0.0, self._steps(start, enters))

    def _timed(self, times: ZoneTimes) -> TaskPhase:
        assert times.enters is not None
        assert times.leaves is not None
        self._book.state.phase = None
        steps = self._steps(times.enters, times.leaves)
        length_m = self._zone.to_m - self._zone.from_m
        return self._book.told(_ZONE, times.enters, times.leaves, length_m, 0.0, steps, times.speed_change)

    def _steps(self, start: Boundary, end: Boundary) -> int | None:
        return self._trail.steps(end.at_ns) - self._trail.steps(start.at_ns) if self._sees_both else None

    def _times(self, scale: float, *, scaled: bool) -> ZoneTimes:
        length = self._length
        ruler, start = Ruler(length.zero_m, scale), LengthStart(length.start_ns, length.turned)
        return self._zone.times(self._trail.state.marks, ruler, start, scaled=scaled)

    def finish(self, now_ns: int) -> list[TaskPhase]:
        """The session ends: with a length that was walked to its end, or within one."""
        length = self._length
        if not length.open or not length.told:
            return []
        if length.turn_ns is not None:
            return self._over(Boundary(length.turn_ns, length.turn_std_s))
        stop = stopped(self._trail, self._parameters)
        if now_ns - stop.at_ns < self._parameters.stopped_s * 1e9:
            return [] if self._book.phase is None else [self._book.end(now_ns, None)]
        return self._over(stop)

    def snapshot(self) -> State:
        """Everything that changes."""
        return {"book": self._book.snapshot(), "turns": self.turns.snapshot(), "length": asdict(self._length)}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._book.restore(state["book"])
        self.turns.restore(state["turns"])
        self._length = LengthState(**state["length"])
