"""What a simulated person truly did: each repetition of a task, cut where the simulation cut it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import Side, Task
from services.bench.exercises.sessions import SeenSession
from services.segmentation.exercises.movements import FOLLOWED

Array = NDArray[np.float64]

HELD = 0.05
"""Share of the range from the farthest point within which it is held: the definition of the metric."""


@dataclass(frozen=True)
class TrueRepetition:
    """One repetition. Angles rad, times s."""

    side: Side | None
    is_partial: bool
    start_s: float
    end_s: float
    reach: float
    hold_s: float
    joints: dict[str, float]
    """Range of each joint."""


def true_repetitions(session: SeenSession, task: Task) -> list[TrueRepetition]:
    """All of them, in order."""
    found: list[TrueRepetition] = []
    number, side = session.truth("repetition"), np.zeros(len(session.time_s))
    movements = {side: movement for movement, side in FOLLOWED[task]}
    if None not in movements:
        side = session.truth("repetition_side")
    edges = np.flatnonzero((np.diff(number) != 0) | (np.diff(side) != 0)) + 1
    for first, end in zip([0, *edges], [*edges, len(number)], strict=True):
        if number[first] == 0 or not np.isfinite(number[first]):
            continue
        to = None if None in movements else Side.RIGHT if side[first] > 0 else Side.LEFT
        part, movement = slice(first, end), movements[to]
        course = movement.angle(*(session.truth(name)[part] for name in movement.needs))
        out = -course if task is Task.TRUNK_TILT_FRONTAL and to is Side.LEFT else course
        found.append(_repetition(to, bool(number[first] < 0), session.time_s[part], out, _joints(session, part)))
    return found


def _joints(session: SeenSession, part: slice) -> dict[str, float]:
    names = [name for name in session.channels if name.startswith(("knee_flexion", "hip_flexion"))]
    return {name: float(np.ptp(session.truth(name)[part])) for name in names}


def _repetition(
    side: Side | None, is_partial: bool, time_s: Array, out: Array, joints: dict[str, float]
) -> TrueRepetition:
    # As told: from the ends to the farthest point, not to where the body may sway beyond upright.
    reach = float(out.max() - min(out[0], out[-1]))
    held = np.flatnonzero(out >= out.max() - HELD * (out.max() - max(out[0], out[-1])))
    return TrueRepetition(
        side, is_partial, float(time_s[0]), float(time_s[-1]), reach, float(time_s[held[-1]] - time_s[held[0]]), joints
    )
