"""What the protocols of walking tests look at."""

from typing import NamedTuple, Protocol

from schemas.tasks import TaskPhase
from services.flow.node import State
from services.segmentation.timed_up_and_go.parameters import TimedUpAndGoParameters
from services.segmentation.timed_up_and_go.trace import Trace
from services.segmentation.timed_up_and_go.turns import Boundary, TurnWatch
from services.segmentation.walking_tests.parameters import WalkingTestParameters
from services.segmentation.walking_tests.step_trail import StepTrail


class Sight(NamedTuple):
    """Steps and headings so far."""

    trace: Trace
    trail: StepTrail
    stands: bool  # the last step was some time ago

    @property
    def now_ns(self) -> int:
        """The newest instant."""
        return self.trace.instants[-1].captured_ns


class WalkingTest(Protocol):
    """One kind of walking test."""

    turns: TurnWatch

    def look(self, sight: Sight) -> list[TaskPhase]:
        """What the newest instant leads to."""

    def finish(self, now_ns: int) -> list[TaskPhase]:
        """The session ends."""

    def snapshot(self) -> State:
        """Everything that changes."""

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""


def turn_watch() -> TurnWatch:
    """Turns as in a timed up and go."""
    return TurnWatch(TimedUpAndGoParameters())


def set_out(trail: StepTrail, p: WalkingTestParameters) -> Boundary:
    """When the row of steps that goes on began."""
    return Boundary(trail.state.begun_ns, p.start_std_s)


def stopped(trail: StepTrail, p: WalkingTestParameters) -> Boundary:
    """When the last step was made."""
    return Boundary(trail.last_ns or 0, p.stop_std_s)
