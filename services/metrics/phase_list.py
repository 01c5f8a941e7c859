"""Phases of a test in order, each as it was last told."""

from collections.abc import Callable, Hashable

from schemas.session import SessionDescription
from schemas.tasks import TaskPhase
from schemas.vocabulary import Segment
from services.biomech.event_sources import used_segments, uses_camera, whole_legs
from services.flow.node import State

NO_STEP_LENGTHS = "no step lengths: they need sensors on pelvis, both thighs and both shanks, or a camera"
NO_HEADING = "no turns are seen: they need a sensor on the pelvis, or on thigh and shank of one leg"


def sees_step_lengths(description: SessionDescription) -> bool:
    """Whether steps have a length."""
    worn = used_segments(description)
    return uses_camera(description) or (Segment.PELVIS in worn and len(whole_legs(worn)) == 2)


def sees_heading(description: SessionDescription) -> bool:
    """Whether turns are seen."""
    worn = used_segments(description)
    return uses_camera(description) or Segment.PELVIS in worn or bool(whole_legs(worn))


class PhaseList:
    """As many as a message takes. `identity` tells which messages are of one phase."""

    def __init__(self, identity: Callable[[TaskPhase], Hashable], most: int) -> None:
        self._identity, self._most = identity, most
        self.phases: list[TaskPhase] = []

    def add(self, phase: TaskPhase) -> None:
        """Put a message in the place of what it tells anew, else at the end."""
        wanted = self._identity(phase)
        for i in range(len(self.phases) - 1, -1, -1):
            if self._identity(self.phases[i]) == wanted:
                self.phases[i] = phase
                return
        if len(self.phases) < self._most:
            self.phases.append(phase)

    def snapshot(self) -> State:
        """The phases."""
        return {"phases": [phase.model_dump(mode="json") for phase in self.phases]}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.phases = [TaskPhase.model_validate(kept) for kept in state["phases"]]
