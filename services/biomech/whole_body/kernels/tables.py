"""The arrays that the kernels of the whole body work on.

Columns of the state: 25 coordinates (3 translations m, 22 angles rad), 12 lengths (m), then the biases of the 15
centres (45, m) where there are any, then 25 velocities and 25 accelerations. What a camera sees directly comes first
and in one piece: the Jacobian's 37 columns, and behind them one column of its own for each row.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

ANGLES = 22
COORDINATES = 25
LENGTHS = 12
CENTRES = 15
KINEMATIC = 40
"""Columns of the Jacobian: 37, filled up to whole vector registers."""
SEEN = COORDINATES + LENGTHS
BIASES = 3 * CENTRES
PRIORS = 12
"""Most soft priors at a time."""


class Tree(NamedTuple):
    """One-axis joints from the root outwards, and the centres on them."""

    parent: Indices  # (22,) joint that carries this one, -1 for the root
    axis: Indices  # (22,) coordinate axis of the parent frame: 0 x, 1 y, 2 z
    sign: Array  # (22,) +1 or -1: direction along that axis
    length: Indices  # (22,) length that sets the joint's offset in its parent, -1 for none
    along: Indices  # (22,) axis of that offset
    share: Array  # (22,) signed share of the length
    carrier: Indices  # (15,) joint whose segment carries the centre
    centre_length: Indices  # (15,)
    centre_along: Indices  # (15,)
    centre_share: Array  # (15,)
    before: Indices  # (15,) centre at the other end of the bone that leads here, -1 for none


class Pose(NamedTuple):
    """Where everything is, in world axes."""

    rotation: Array  # (22, 3, 3) R_world_from_segment behind each joint
    axis: Array  # (22, 3) joint axis, positive direction
    origin: Array  # (22, 3) m
    centre: Array  # (15, 3) m


def empty_pose() -> Pose:
    """Room for a pose."""
    return Pose(np.zeros((ANGLES, 3, 3)), np.zeros((ANGLES, 3)), np.zeros((ANGLES, 3)), np.zeros((CENTRES, 3)))
