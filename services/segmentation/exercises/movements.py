"""What is followed in each task, out of joint coordinates: vocabulary.MOVEMENTS."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import Side, Task
from services.segmentation.batch import INDEX, Batch

Array = NDArray[np.float64]

TRUNK_JOINT = 0.55
"""Share of the trunk's length, from the hips up, at which the whole body bends (services/biomech/whole_body)."""

_MOVE = 1e-4
"""rad; every movement is smooth over it."""

_KNEES = ("knee_flexion_right", "knee_flexion_left")
_TRUNK = ("pelvis_tilt", "pelvis_obliquity", "trunk_flexion")


@dataclass(frozen=True, slots=True)
class Course:
    """A movement over a batch, each (n,): rad, rad/s and rad; and whether every coordinate of it is valid."""

    angle: Array
    rate: Array
    std: Array
    is_valid: bool


@dataclass(frozen=True, slots=True)
class Movement:
    """A row of MOVEMENTS: the coordinates that it needs, and what it makes of them.

    `angle` takes one array per coordinate and gives their movement, rad, for arrays of any shape.
    """

    name: str
    needs: tuple[str, ...]
    angle: Callable[..., Array]

    def course(self, batch: Batch) -> Course | None:
        """The movement, its rate and deviation; both to first order, the coordinates taken as independent.

        None for a body model that lacks a coordinate.
        """
        columns = [INDEX[name] for name in self.needs]
        if max(columns) >= len(batch.valid):
            return None
        position, velocity, std = (
            table[:, columns].T for table in (batch.position, batch.velocity, batch.position_std)
        )
        number = len(columns)
        # As it is, then with each coordinate moved up, then down, for central differences.
        moves = np.vstack([np.zeros((1, number)), _MOVE * np.eye(number), -_MOVE * np.eye(number)]).T
        angles = self.angle(*(position[:, None, :] + moves[:, :, None]))
        slopes = (angles[1 : number + 1] - angles[number + 1 :]) / (2.0 * _MOVE)
        rate, variance = np.sum(slopes * velocity, axis=0), np.sum((slopes * std) ** 2, axis=0)
        return Course(angles[0], rate, np.sqrt(variance), bool(batch.valid[columns].all()))


def squat_depth(right: Array, left: Array) -> Array:
    """rad, mean flexion of both knees."""
    return 0.5 * (right + left)


def trunk_lean(tilt: Array, obliquity: Array, flexion: Array) -> tuple[Array, Array]:
    """rad, forward and to the right: inclination of the line from spine_base to spine_shoulder.

    With the pelvis's own heading as forward, axes x forward, y up, z right, and u = Rz(-tilt) Rx(-obliquity), that line
    is s u y + (1 - s) u Rz(-flexion) y, s = TRUNK_JOINT.
    """
    ahead = (1.0 - TRUNK_JOINT) * np.sin(flexion)
    up = TRUNK_JOINT + (1.0 - TRUNK_JOINT) * np.cos(flexion)
    right, level = -np.sin(obliquity) * up, np.cos(obliquity) * up
    forward = np.cos(tilt) * ahead + np.sin(tilt) * level
    upward = np.cos(tilt) * level - np.sin(tilt) * ahead
    return np.arctan2(forward, upward), np.arctan2(right, upward)


SQUAT_DEPTH = Movement("squat_depth", _KNEES, squat_depth)
LEAN_FORWARD = Movement("trunk_lean_forward", _TRUNK, lambda *angles: trunk_lean(*angles)[0])
LEAN_RIGHT = Movement("trunk_lean_right", _TRUNK, lambda *angles: trunk_lean(*angles)[1])
HIP_FLEXION = {side: Movement(f"hip_flexion_{side}", (f"hip_flexion_{side}",), np.positive) for side in Side}

FOLLOWED: dict[Task, tuple[tuple[Movement, Side | None], ...]] = {
    Task.SQUAT: ((SQUAT_DEPTH, None),),
    Task.STEPPING: tuple((HIP_FLEXION[side], side) for side in Side),
    Task.TRUNK_TILT_SAGITTAL: ((LEAN_FORWARD, None),),
    Task.TRUNK_TILT_FRONTAL: tuple((LEAN_RIGHT, side) for side in Side),
}
"""What repetitions of a task are counted on, and their side."""
