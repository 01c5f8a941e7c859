"""What a source's joint states say of the shared angles, kept for as long as the other source may need it."""

from collections import deque
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.kinematics import JointState
from schemas.rhythm import Rhythm
from schemas.vocabulary import BODY_MODELS
from services.biomech.fusion.parameters import SHARED
from services.biomech.fusion.shared_angles import Told, Turn
from services.biomech.whole_body.directions import LARGEST_DEVIATION
from services.biomech.whole_body.observability import OTHER_SHARE
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]

COLUMNS = {
    model: np.array([[dof.name for dof in dofs].index(name) for name in SHARED]) for model, dofs in BODY_MODELS.items()
}
"""Model -> (11,) its columns of the shared angles."""

SUREST = LARGEST_DEVIATION * OTHER_SHARE
"""rad. A camera's angle may be shown with a larger deviation, but teaches nothing then."""


class Reading(NamedTuple):
    """One row of a source."""

    captured_ns: int
    told: Told
    acceleration: Array  # (11,) rad/s^2
    turn: Turn | None


def readings(joints: JointState, rhythm: Rhythm | None = None) -> list[Reading]:
    """Every row of a message, with the rhythm's message of the same rows."""
    columns = COLUMNS[joints.model]
    valid = np.array(joints.valid)[columns]
    tables = (joints.position, joints.velocity, joints.position_std, joints.acceleration)
    position, velocity, std, acceleration = (np.array(table, dtype=np.float64)[:, columns] for table in tables)
    sure = std <= SUREST if joints.model == "whole_body" else np.ones_like(std, dtype=np.bool_)
    return [
        Reading(captured_ns, Told(position[k], velocity[k], std[k], valid & sure[k]), acceleration[k], _turn(rhythm, k))
        for k, captured_ns in enumerate(joints.captured_ns)
    ]


def _turn(rhythm: Rhythm | None, k: int) -> Turn | None:
    return Turn(rhythm.phase[k], rhythm.frequency[k]) if rhythm is not None and rhythm.locked[k] else None


def carried(reading: Reading, to_ns: int) -> tuple[Told, Turn | None]:
    """The same some moments later, if it goes on as it went."""
    dt_s, told, turn = (to_ns - reading.captured_ns) / 1e9, reading.told, reading.turn
    later = None if turn is None else turn._replace(phase=turn.phase + turn.rate * dt_s)
    return told._replace(position=told.position + told.velocity * dt_s), later


class History:
    """The newest readings of one source, oldest first."""

    def __init__(self, most: int) -> None:
        self._kept: deque[Reading] = deque(maxlen=most)

    def append(self, reading: Reading) -> None:
        """Take the next one."""
        self._kept.append(reading)

    @property
    def newest(self) -> Reading | None:
        """The last one."""
        return self._kept[-1] if self._kept else None

    def at(self, captured_ns: int, longest_gap_ns: int) -> Told | None:
        """What the source said at that time, between two of its readings; None outside of them or in a gap."""
        after = None
        for before in reversed(self._kept):
            if before.captured_ns <= captured_ns:
                if after is None:
                    return before.told if before.captured_ns == captured_ns else None
                return _between(before, after, captured_ns, longest_gap_ns)
            after = before
        return None

    def of(self, times_ns: list[int]) -> list[Reading]:
        """Those of these times, in order."""
        return [reading for reading in self._kept if reading.captured_ns in times_ns]

    def snapshot(self) -> State:
        """All of them."""
        rows = [np.concatenate([*r.told[:3], r.acceleration, r.told.valid.astype(float)]) for r in self._kept]
        return {
            "captured_ns": [reading.captured_ns for reading in self._kept],
            "rows": pack_array(np.array(rows).reshape(-1, 5 * len(SHARED))),
            "turns": [None if reading.turn is None else list(reading.turn) for reading in self._kept],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._kept.clear()
        rows = unpack_array(state["rows"])
        for captured_ns, row, turn in zip(state["captured_ns"], rows, state["turns"], strict=True):
            position, velocity, std, acceleration, valid = np.split(row, 5)
            told = Told(position, velocity, std, valid > 0.5)
            self._kept.append(Reading(captured_ns, told, acceleration, None if turn is None else Turn(*turn)))


def _between(before: Reading, after: Reading, captured_ns: int, longest_gap_ns: int) -> Told | None:
    span_ns = after.captured_ns - before.captured_ns
    if span_ns > longest_gap_ns:
        return None
    share = (captured_ns - before.captured_ns) / span_ns
    first, second = before.told, after.told
    return Told(
        first.position + share * (second.position - first.position),
        first.velocity + share * (second.velocity - first.velocity),
        np.maximum(first.std, second.std),
        first.valid & second.valid,
    )
