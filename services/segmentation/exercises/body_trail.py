"""The last of the whole body: what moved how far within a repetition, and whether it was the exercise at all."""

from bisect import bisect_left, bisect_right

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import JointCentre, Side, Task
from services.flow.node import State, pack_array, unpack_array
from services.segmentation.batch import COLUMNS, INDEX, Batch, Centres
from services.segmentation.exercises.parameters import ExerciseParameters

Array = NDArray[np.float64]

LEGS_APART = "the legs did not move together"
WALKED = "the person walked"

ARM_ELEVATION = "arm_elevation"
_ARM = {
    side: tuple(list(JointCentre).index(JointCentre(f"{joint}_{side}")) for joint in ("shoulder", "elbow"))
    for side in Side
}
_SPINE = [list(JointCentre).index(JointCentre(f"spine_{part}")) for part in ("shoulder", "mid")]
EXTRAS = (*(f"{ARM_ELEVATION}_{side}" for side in Side), "x", "z")
"""What is kept beside the joint coordinates: rad, and the place of the pelvis in the room, m."""
NAMES = (*COLUMNS, *EXTRAS[:2])
"""What a range is told of."""


def arm_elevation(centres: Centres, side: Side) -> Array:
    """(n,) rad between the upper arm and the trunk's downward axis, 0 hanging, whatever lifts it."""
    shoulder, elbow = (centres.position[:, joint] for joint in _ARM[side])
    top, middle = (centres.position[:, joint] for joint in _SPINE)
    arm, down = elbow - shoulder, middle - top
    across = np.linalg.norm(np.cross(down, arm), axis=1)
    return np.asarray(np.arctan2(across, np.sum(down * arm, axis=1)))


class BodyTrail:
    """Rows in order of time: joint coordinates, then EXTRAS; NaN what was not seen. No message carries one."""

    def __init__(self, task: Task, parameters: ExerciseParameters) -> None:
        self._task = task
        self._parameters = parameters
        self._captured_ns: list[int] = []
        self._rows: list[Array] = []

    def append(self, batch: Batch) -> None:
        """Add the samples of a batch."""
        table = np.full((len(batch.captured_ns), len(COLUMNS) + len(EXTRAS)), np.nan)
        width = batch.position.shape[1]
        table[:, :width] = np.where(batch.valid, batch.position, np.nan)
        if batch.centres is not None:
            table[:, len(COLUMNS) :] = _extras(batch.centres)
        self._captured_ns += batch.captured_ns.tolist()
        self._rows += list(table)

    def forget_before(self, captured_ns: int) -> None:
        """Drop what is older."""
        old = bisect_left(self._captured_ns, captured_ns)
        del self._captured_ns[:old], self._rows[:old]

    def ranges(self, start_ns: int, end_ns: int) -> dict[str, float]:
        """rad, largest minus smallest angle of what was seen all the time."""
        table = self._within(start_ns, end_ns)
        if not len(table):
            return {}
        spans = np.ptp(table, axis=0)
        # Six decimals, 1e-6 rad, keep the message short.
        return {name: round(float(span), 6) for name, span in zip(NAMES, spans, strict=False) if np.isfinite(span)}

    def flaw(self, start_ns: int, end_ns: int, reach: float) -> str | None:
        """Why a movement is none of the exercise: a walk to the place, for one."""
        p, table = self._parameters, self._within(start_ns, end_ns)
        if not len(table):
            return None
        if np.linalg.norm(table[-1, -2:] - table[0, -2:]) > p.walked_m:
            return WALKED
        if self._task is Task.SQUAT:
            right, left = (table[:, INDEX[f"knee_flexion_{side}"]] for side in (Side.RIGHT, Side.LEFT))
            if np.ptp(right - left) > p.legs_apart_share * reach:
                return LEGS_APART
        return None

    def _within(self, start_ns: int, end_ns: int) -> Array:
        first, last = bisect_left(self._captured_ns, start_ns), bisect_right(self._captured_ns, end_ns)
        return np.array(self._rows[first:last])

    def snapshot(self) -> State:
        """Times and rows; what was not seen as a bit of its own, since numbers that are none go into no state."""
        table = np.array(self._rows).reshape(-1, len(COLUMNS) + len(EXTRAS))
        unseen = np.isnan(table)
        return {
            "captured_ns": list(self._captured_ns),
            "rows": pack_array(np.where(unseen, 0.0, table)),
            "unseen": ["".join("1" if flag else "0" for flag in row) for row in unseen],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._captured_ns = list(state["captured_ns"])
        table = unpack_array(state["rows"])
        for row, flags in zip(table, state["unseen"], strict=True):
            row[[flag == "1" for flag in flags]] = np.nan
        self._rows = list(table)


def _extras(centres: Centres) -> Array:
    """(n, 4) as EXTRAS."""
    pelvis = np.where(centres.seen[0], centres.position[:, 0], np.nan)
    arms = [
        arm_elevation(centres, side) if centres.seen[[*_ARM[side], *_SPINE]].all() else np.full(len(pelvis), np.nan)
        for side in Side
    ]
    return np.column_stack([*arms, pelvis[:, 0], pelvis[:, 2]])
