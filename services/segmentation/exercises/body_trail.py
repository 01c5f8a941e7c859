"""The last of the whole body: what moved how far within a repetition, and whether it was the exercise at all."""

from bisect import bisect_left, bisect_right

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import JointCentre, Side, Task
from services.flow.node import State, pack_array, unpack_array
from services.segmentation.batch import COLUMNS, INDEX, Batch, Centres
from services.segmentation.exercises.parameters import ExerciseParameters

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

LEGS_APART = "the legs did not move together"
NOT_STANDING = "it did not begin and end standing"
WALKED = "the person walked"

ARM_ELEVATION = "arm_elevation"
_ARM = {
    side: tuple(list(JointCentre).index(JointCentre(f"{joint}_{side}")) for joint in ("shoulder", "elbow"))
    for side in Side
}
_SPINE = [list(JointCentre).index(JointCentre(f"spine_{part}")) for part in ("shoulder", "mid")]
EXTRAS = (*(f"{ARM_ELEVATION}_{side}" for side in Side), "x", "z")
"""What is kept beside the joint coordinates: rad, and the place of the pelvis in the room, m."""
WIDTH = len(COLUMNS) + len(EXTRAS)
NAMES = (*COLUMNS, *EXTRAS[:2])
"""What a range is told of."""


def arm_elevation(centres: Centres, side: Side) -> Array:
    """(n,) rad between the upper arm and the trunk's downward axis, 0 hanging, whatever lifts it."""
    shoulder, elbow = (centres.position[:, joint] for joint in _ARM[side])
    top, middle = (centres.position[:, joint] for joint in _SPINE)
    (ax, ay, az), (bx, by, bz) = (elbow - shoulder).T, (middle - top).T
    across = np.sqrt((ay * bz - az * by) ** 2 + (az * bx - ax * bz) ** 2 + (ax * by - ay * bx) ** 2)
    return np.asarray(np.arctan2(across, ax * bx + ay * by + az * bz))


class BodyTrail:
    """Rows in order of time: joint coordinates, then EXTRAS, as they are estimated, and which of them were seen."""

    def __init__(self, task: Task, parameters: ExerciseParameters) -> None:
        self._task = task
        self._parameters = parameters
        self._captured_ns: list[int] = []
        self._rows: list[Array] = []
        self._seen: list[Flags] = []

    def append(self, batch: Batch) -> None:
        """Add the samples of a batch."""
        n, width = batch.position.shape
        table, seen = np.zeros((n, WIDTH)), np.zeros((n, WIDTH), dtype=np.bool_)
        table[:, :width], seen[:, :width] = batch.position, batch.valid
        if batch.centres is not None:
            table[:, len(COLUMNS) :], seen[:, len(COLUMNS) :] = _extras(batch.centres)
        self._captured_ns += batch.captured_ns.tolist()
        self._rows += list(table)
        self._seen += list(seen)

    def forget_before(self, captured_ns: int) -> None:
        """Drop what is older."""
        old = bisect_left(self._captured_ns, captured_ns)
        del self._captured_ns[:old], self._rows[:old], self._seen[:old]

    def ranges(self, start_ns: int, end_ns: int) -> dict[str, float]:
        """rad, largest minus smallest angle of what was seen, but for moments."""
        part = self._within(start_ns, end_ns)
        table, seen = np.array(self._rows[part]), np.array(self._seen[part])
        if not len(table):
            return {}
        enough = seen.mean(axis=0) >= self._parameters.seen_share
        # Six decimals, 1e-6 rad, keep the message short.
        return {
            name: round(float(np.ptp(table[:, k])), 6)
            for k, name in enumerate(NAMES)
            if enough[k] and self._longest_unseen_s(part, seen[:, k]) <= self._parameters.longest_unseen_s
        }

    def _longest_unseen_s(self, part: slice, seen: Flags) -> float:
        captured_ns = np.array(self._captured_ns[part])
        at = np.concatenate([captured_ns[:1], captured_ns[seen], captured_ns[-1:]])
        return float(np.diff(at).max()) / 1e9

    def flaw(self, start_ns: int, end_ns: int, reach: float) -> str | None:
        """Why a movement is none of the exercise: a walk to the place, for one."""
        p, part = self._parameters, self._within(start_ns, end_ns)
        table, seen = np.array(self._rows[part]), np.array(self._seen[part])
        if not len(table):
            return None
        if seen[[0, -1], -1].all() and np.linalg.norm(table[-1, -2:] - table[0, -2:]) > p.walked_m:
            return WALKED
        if self._task is Task.SQUAT:
            right, left = (table[:, INDEX[f"knee_flexion_{side}"]] for side in (Side.RIGHT, Side.LEFT))
            if np.ptp(right - left) > p.legs_apart_share * reach:
                return LEGS_APART
            depth = right + left
            if max(depth[0], depth[-1]) > p.standing_share * depth.max():
                return NOT_STANDING
        return None

    def _within(self, start_ns: int, end_ns: int) -> slice:
        return slice(bisect_left(self._captured_ns, start_ns), bisect_right(self._captured_ns, end_ns))

    def snapshot(self) -> State:
        """Times, rows and what was seen."""
        return {
            "captured_ns": list(self._captured_ns),
            "rows": pack_array(np.array(self._rows).reshape(-1, WIDTH)),
            "seen": ["".join("1" if flag else "0" for flag in row) for row in self._seen],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._captured_ns = list(state["captured_ns"])
        self._rows = list(unpack_array(state["rows"]))
        self._seen = [np.array([digit == "1" for digit in digits]) for digits in state["seen"]]


def _extras(centres: Centres) -> tuple[Array, Flags]:
    """(n, 4) as EXTRAS, and (4,) which of them were seen."""
    pelvis = centres.position[:, 0]
    arms = [arm_elevation(centres, side) for side in Side]
    arms_seen = [bool(centres.seen[[*_ARM[side], *_SPINE]].all()) for side in Side]
    seen = np.array([*arms_seen, centres.seen[0], centres.seen[0]])
    return np.column_stack([*arms, pelvis[:, 0], pelvis[:, 2]]), seen
