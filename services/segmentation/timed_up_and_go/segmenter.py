"""The samples of a session, thinned to instants, to the phases of its attempts."""

from schemas.kinematics import SegmentMotion
from schemas.session import SessionDescription
from schemas.signals import TASK_PHASE
from schemas.tasks import TaskPhase
from schemas.vocabulary import Segment
from services.biomech.event_sources import lone_segments, used_segments
from services.flow.message import Output
from services.flow.node import State
from services.segmentation.batch import Batch
from services.segmentation.gait.lone_motion import LoneMotion
from services.segmentation.timed_up_and_go.attempts import Attempts
from services.segmentation.timed_up_and_go.instants import VerticalSpeed, instant, rates_of, sight
from services.segmentation.timed_up_and_go.parameters import TimedUpAndGoParameters
from services.segmentation.timed_up_and_go.posture import Posture
from services.segmentation.timed_up_and_go.trace import Trace

_THIGHS = {Segment.THIGH_LEFT, Segment.THIGH_RIGHT}
DEFAULTS = TimedUpAndGoParameters()


class TimedUpAndGoSegmenter:
    """Phases as they begin and end. Pure; decides instant by instant, whatever a message holds."""

    def __init__(self, description: SessionDescription, parameters: TimedUpAndGoParameters = DEFAULTS) -> None:
        p = self._parameters = parameters
        worn = used_segments(description)
        by_pelvis = not worn & _THIGHS and Segment.PELVIS in lone_segments(worn)
        self._pelvis = VerticalSpeed(p) if by_pelvis else None
        self._lone = LoneMotion()
        self._trace = Trace(p.memory_s)
        self._posture = Posture(p)
        self._attempts = Attempts(p, sees_both={Segment.SHANK_LEFT, Segment.SHANK_RIGHT} <= worn)
        self._last_ns: int | None = None
        self._posture_ns: int | None = None

    def take_motion(self, motion: SegmentMotion | None) -> int:
        """The motion of lone segments at the samples that come next. Returns how many of its samples are unusable."""
        return self._lone.take(motion) if self._pelvis is not None else 0

    def take(self, batch: Batch) -> list[Output]:
        """Phases that begin or end with these samples."""
        seen = sight(batch)
        rates = rates_of(seen)
        outputs: list[Output] = []
        for i, captured_ns in enumerate(batch.captured_ns.tolist()):
            outputs += self._note_gap(captured_ns)
            sees_posture = seen.thigh is not None
            if self._pelvis is not None:
                motion = self._lone.at(Segment.PELVIS, captured_ns)
                sees_posture = motion is not None
                if motion is not None:
                    self._pelvis.step(captured_ns, motion)
            if sees_posture:
                self._posture_ns = captured_ns
            if self._is_new_instant(captured_ns):
                self._trace.append(instant(captured_ns, seen, i, self._pelvis))
                outputs += self._look(captured_ns, rates[i])
            self._last_ns = captured_ns
        return outputs

    def finish(self) -> list[Output]:
        """The attempt that goes on when the session ends."""
        now_ns = self._last_ns or 0
        return _sent(now_ns, self._attempts.give_up(now_ns))

    def _is_new_instant(self, captured_ns: int) -> bool:
        """By captured time alone, so that batches and sensor rates decide nothing."""
        every_ns = round(self._parameters.instant_s * 1e9)
        return self._last_ns is None or captured_ns // every_ns != self._last_ns // every_ns

    def _look(self, captured_ns: int, shank_rates: list[float]) -> list[Output]:
        newest = self._trace.instants[-1]
        self._attempts.steps.step(newest, shank_rates)
        change = self._posture.step(self._trace)
        return _sent(captured_ns, self._attempts.step(self._trace, change))

    def _note_gap(self, captured_ns: int) -> list[Output]:
        """The posture was out of sight for so long that anything may have happened."""
        posture_ns = self._posture_ns
        if posture_ns is None or captured_ns - posture_ns <= self._parameters.longest_gap_s * 1e9:
            return []
        self._posture.forget()
        self._trace.clear()
        self._posture_ns = None
        return _sent(captured_ns, self._attempts.give_up(posture_ns))

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "lone": self._lone.snapshot(),
            "pelvis": None if self._pelvis is None else self._pelvis.snapshot(),
            "trace": self._trace.snapshot(),
            "posture": self._posture.snapshot(),
            "attempts": self._attempts.snapshot(),
            "last_ns": self._last_ns,
            "posture_ns": self._posture_ns,
        }

    def restore(self, state: State) -> None:
        """Go on from a snapshot."""
        self._lone.restore(state["lone"])
        if self._pelvis is not None:
            self._pelvis.restore(state["pelvis"])
        self._trace.restore(state["trace"])
        self._posture.restore(state["posture"])
        self._attempts.restore(state["attempts"])
        self._last_ns, self._posture_ns = state["last_ns"], state["posture_ns"]


def _sent(captured_ns: int, phases: list[TaskPhase]) -> list[Output]:
    return [Output(TASK_PHASE, captured_ns, phase) for phase in phases]
