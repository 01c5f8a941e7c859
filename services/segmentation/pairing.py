"""Brings each joint_state message together with the rhythm of the same samples."""

from collections import deque

from schemas.kinematics import JointState
from schemas.rhythm import Rhythm
from services.flow.node import State


class Pairing:
    """Holds whichever of the two comes first.

    Both streams are in order, so a message whose partner's stream has gone past it will never get a partner.
    The pairs come out in the same order however the streams interleave.
    """

    def __init__(self) -> None:
        self._joints: deque[JointState] = deque()
        self._rhythms: deque[Rhythm] = deque()

    def add_joints(self, joints: JointState) -> list[tuple[JointState, Rhythm | None]]:
        """Take a non-empty batch of joint states; the pairs that are now complete."""
        self._joints.append(joints)
        return self._drain()

    def add_rhythm(self, rhythm: Rhythm) -> list[tuple[JointState, Rhythm | None]]:
        """Take a non-empty batch of the rhythm; the pairs that are now complete."""
        self._rhythms.append(rhythm)
        return self._drain()

    def flush(self) -> list[tuple[JointState, Rhythm | None]]:
        """Both streams have ended: what is left has no partner."""
        self._rhythms.clear()
        rest: list[tuple[JointState, Rhythm | None]] = [(joints, None) for joints in self._joints]
        self._joints.clear()
        return rest

    def _drain(self) -> list[tuple[JointState, Rhythm | None]]:
        pairs: list[tuple[JointState, Rhythm | None]] = []
        while self._joints and self._rhythms:
            joints, rhythm = self._joints[0], self._rhythms[0]
            if joints.captured_ns == rhythm.captured_ns:
                self._rhythms.popleft()
                pairs.append((self._joints.popleft(), rhythm))
            elif rhythm.captured_ns[-1] <= joints.captured_ns[-1]:
                self._rhythms.popleft()
            else:
                pairs.append((self._joints.popleft(), None))
        return pairs

    def snapshot(self) -> State:
        """The messages that wait."""
        return {
            "joints": [joints.model_dump() for joints in self._joints],
            "rhythms": [rhythm.model_dump() for rhythm in self._rhythms],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._joints = deque(JointState.model_validate(joints) for joints in state["joints"])
        self._rhythms = deque(Rhythm.model_validate(rhythm) for rhythm in state["rhythms"])
