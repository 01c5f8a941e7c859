"""Messages become arrays, and what cannot be used is counted."""

from operator import lt

import numpy as np
from numpy.typing import NDArray

from schemas.health import Reason, Rejection
from schemas.kinematics import JointState
from schemas.rhythm import Rhythm
from schemas.signals import JOINT_STATE, RHYTHM, SEGMENT_MOTION
from services.flow.message import Stream
from services.flow.node import State
from services.segmentation.batch import DOFS, Batch

Array = NDArray[np.float64]

JOINTS_FROM = Stream(JOINT_STATE, "estimation")
RHYTHM_FROM = Stream(RHYTHM, "estimation")
MOTION_FROM = Stream(SEGMENT_MOTION, "estimation")

MOST_ANGLE, MOST_RATE = 1e4, 200.0
"""rad and rad/s; beyond them a value is no joint coordinate (pelvis_rotation counts whole turns)."""
_LIMITS = np.array([MOST_ANGLE, MOST_RATE, MOST_ANGLE])[:, None, None]

MOST_PHASE = 1e9
"""rad, beyond the strides of a lifetime."""

LATEST_NS = 10**17
"""ns, three years; a session time beyond it is none."""


class Intake:
    """Checks samples; remembers how many were not used, and why."""

    def __init__(self) -> None:
        self._newest_ns = -1
        self._rejected: dict[tuple[str, Reason], int] = {}

    def take(self, joints: JointState, rhythm: Rhythm | None) -> Batch | None:
        """The usable samples of a message; None when there are none."""
        rows = len(joints.captured_ns)
        tables = _tables(joints)
        if tables is None:
            self._reject(JOINTS_FROM, Reason.WRONG_SHAPE, rows)
            return None
        if max(map(abs, joints.captured_ns)) > LATEST_NS:
            self._reject(JOINTS_FROM, Reason.OUT_OF_RANGE, rows)
            return None
        captured_ns = np.array(joints.captured_ns, dtype=np.int64)
        use = self._usable(captured_ns, tables)
        if use is None:
            return None
        self._newest_ns = int(captured_ns[use][-1])
        position, velocity, std = tables[:, use]
        phase = self._phase(rhythm, rows)[use]
        valid, observed = np.array(joints.valid), frozenset(joints.observed)
        return Batch(captured_ns[use], position, velocity, phase, std, valid, observed)

    def refuse_motion(self, count: int) -> None:
        """Count samples of lone segments that can not be used."""
        self._reject(MOTION_FROM, Reason.OUT_OF_RANGE, count)

    def _usable(self, captured_ns: NDArray[np.int64], tables: Array) -> NDArray[np.bool_] | slice | None:
        """Which rows to use, None for none. Almost always all of them, which is looked at first."""
        bounded = np.abs(tables) < _LIMITS
        times = captured_ns.tolist()
        if all(map(lt, [self._newest_ns, *times], times)) and bounded.all():
            return slice(None)
        newest = np.maximum.accumulate(np.concatenate([[self._newest_ns], captured_ns]))
        later = captured_ns > newest[:-1]
        use: NDArray[np.bool_] = later & bounded.all(axis=(0, 2))
        self._reject(JOINTS_FROM, Reason.CLOCK_BACKWARDS, int(np.sum(~later)))
        self._reject(JOINTS_FROM, Reason.OUT_OF_RANGE, int(np.sum(later & ~use)))
        return use if use.any() else None

    def _phase(self, rhythm: Rhythm | None, rows: int) -> Array:
        if rhythm is None:
            return np.full(rows, np.nan)
        if len(rhythm.phase) != rows or len(rhythm.locked) != rows:
            self._reject(RHYTHM_FROM, Reason.WRONG_SHAPE, rows)
            return np.full(rows, np.nan)
        phase = np.array(rhythm.phase, dtype=np.float64)
        return np.where(np.array(rhythm.locked) & (np.abs(phase) < MOST_PHASE), phase, np.nan)

    def _reject(self, stream: Stream, reason: Reason, count: int) -> None:
        if count:
            key = (stream.name, reason)
            self._rejected[key] = self._rejected.get(key, 0) + count

    def rejections(self) -> list[Rejection]:
        """Samples that were not used."""
        return [
            Rejection(subject=subject, reason=reason, count=count)
            for (subject, reason), count in sorted(self._rejected.items())
        ]

    def snapshot(self) -> State:
        """The newest time and the counts."""
        rejected = [[subject, reason.value, count] for (subject, reason), count in self._rejected.items()]
        return {"newest_ns": self._newest_ns, "rejected": rejected}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._newest_ns = state["newest_ns"]
        self._rejected = {(subject, Reason(reason)): count for subject, reason, count in state["rejected"]}


def _tables(joints: JointState) -> Array | None:
    """Position, velocity and deviation (3, n, 15); None when the message has another shape."""
    if joints.model != "lower_body" or len(joints.valid) != DOFS:
        return None
    try:
        tables = np.array([joints.position, joints.velocity, joints.position_std], dtype=np.float64)
    except ValueError:
        return None
    return tables if tables.shape == (3, len(joints.captured_ns), DOFS) else None
