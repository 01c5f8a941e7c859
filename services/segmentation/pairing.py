"""Brings each joint_state message together with what else is known of the same samples."""

from collections import deque
from typing import NamedTuple, TypeVar

from schemas.kinematics import JointCentres, JointState, SegmentMotion
from schemas.rhythm import Rhythm
from services.flow.node import State

Accompanying = TypeVar("Accompanying", Rhythm, SegmentMotion, JointCentres)


class Together(NamedTuple):
    """Messages of the same samples; what never came is None."""

    joints: JointState
    rhythm: Rhythm | None
    motion: SegmentMotion | None
    centres: JointCentres | None = None


class Pairing:
    """Holds whichever comes first.

    All streams are in order, so a message whose partner's stream has gone past it will never get that partner.
    What belongs together comes out in the same order however the streams interleave.
    """

    def __init__(self, *, with_motion: bool = False, with_centres: bool = False) -> None:
        self._joints: deque[JointState] = deque()
        self._rhythms: deque[Rhythm] = deque()
        self._motions: deque[SegmentMotion] = deque()
        self._centres: deque[JointCentres] = deque()
        self._with_motion = with_motion
        self._with_centres = with_centres

    def add_joints(self, joints: JointState) -> list[Together]:
        """Take a non-empty batch of joint states; what is now complete."""
        self._joints.append(joints)
        return self._drain()

    def add_rhythm(self, rhythm: Rhythm) -> list[Together]:
        """Take a non-empty batch of the rhythm; what is now complete."""
        self._rhythms.append(rhythm)
        return self._drain()

    def add_motion(self, motion: SegmentMotion) -> list[Together]:
        """Take a non-empty batch of lone segments' motion; what is now complete."""
        self._motions.append(motion)
        return self._drain()

    def add_centres(self, centres: JointCentres) -> list[Together]:
        """Take a non-empty batch of joint centres; what is now complete."""
        self._centres.append(centres)
        return self._drain()

    def flush(self) -> list[Together]:
        """All streams have ended: joint states get the partners that came."""
        return self._drain(ended=True)

    def _drain(self, *, ended: bool = False) -> list[Together]:
        complete: list[Together] = []
        while self._joints:
            joints = self._joints[0]
            _drop_passed(self._rhythms, joints)
            _drop_passed(self._motions, joints)
            _drop_passed(self._centres, joints)
            if self._waits() and not ended:
                break
            self._joints.popleft()
            partners = _partner(self._rhythms, joints), _partner(self._motions, joints), _partner(self._centres, joints)
            complete.append(Together(joints, *partners))
        return complete

    def _waits(self) -> bool:
        if not self._rhythms or (self._with_motion and not self._motions):
            return True
        return self._with_centres and not self._centres

    def snapshot(self) -> State:
        """The messages that wait."""
        return {
            "joints": [joints.model_dump() for joints in self._joints],
            "rhythms": [rhythm.model_dump() for rhythm in self._rhythms],
            "motions": [motion.model_dump() for motion in self._motions],
            "centres": [centres.model_dump() for centres in self._centres],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._joints = deque(JointState.model_validate(joints) for joints in state["joints"])
        self._rhythms = deque(Rhythm.model_validate(rhythm) for rhythm in state["rhythms"])
        self._motions = deque(SegmentMotion.model_validate(motion) for motion in state["motions"])
        self._centres = deque(JointCentres.model_validate(centres) for centres in state["centres"])


def _drop_passed(queue: deque[Accompanying], joints: JointState) -> None:
    """Drop what ends no later than the joint states and is not theirs: its own never came."""
    while queue and queue[0].captured_ns != joints.captured_ns and queue[0].captured_ns[-1] <= joints.captured_ns[-1]:
        queue.popleft()


def _partner(queue: deque[Accompanying], joints: JointState) -> Accompanying | None:
    return queue.popleft() if queue and queue[0].captured_ns == joints.captured_ns else None
