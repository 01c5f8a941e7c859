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


class Columns(NamedTuple):
    """Which columns of the Jacobian move a centre."""

    table: Indices  # (15, deepest), the three translations first
    used: Indices  # (15,) how many of the table's row


class Noise(NamedTuple):
    """What the camera is believed, as variances."""

    variance: Array  # (15,) m^2 per axis of a tracked centre
    along: Array  # (15,) more along the bone that leads to the centre, in squares of that bone
    inferred: float  # factor on both of an inferred centre
    stretch: float  # m by which a seen bone may differ from the model's before its ends are doubted; 0: never
    gate: float  # squared innovation, in variances, from which a centre is believed less; 0: never


class Priors(NamedTuple):
    """Soft pseudo-measurements of single angles at every frame."""

    column: Indices  # (p,) column of the state
    value: Array  # (p,) rad
    variance: Array  # (p,) rad^2


class Update(NamedTuple):
    """Scratch of the measurement update, and what it found."""

    pose: Pose
    H: Array  # (45, 40) Jacobian of all centres
    rows: Array  # (45, 40) of the centres in use, one after another
    used: Indices  # (15,) centres in use, the first `in_use[0]`
    in_use: Indices  # (1,) how many
    innovation: Array  # (15, 3) m
    doubt: Array  # (15,) factor on the variance of a centre at the end of a bone of wrong length
    distance: Array  # (15,) squared innovation in variances, 3 expected; of a centre in use
    W: Array  # (60, M)
    turned: Array  # (40, 60) what of W is seen, transposed
    S: Array  # (60, 60) innovation covariance, after the update its Cholesky factor in the upper triangle
    y: Array  # (60,)
    pivot: Array  # (60,) reciprocal diagonal of the factor
    dx: Array  # (M,)
    evidence: Array  # (2,) squared innovations in variances, and log determinant, of the centres alone


class Bounds(NamedTuple):
    """low <= x[column] <= high, and scratch of the projection."""

    column: Indices  # (b,)
    low: Array  # (b,)
    high: Array  # (b,)
    active: Indices  # (b,) place in `column`
    sign: Array  # (b,) +1 at the high bound
    multiplier: Array  # (b,)
    factor: Array  # (b, b)
    trial: Array  # (b,)


def empty_update(width: int) -> Update:
    """Room for an update with covariance rows of `width`."""
    rows = 3 * CENTRES + PRIORS + 3
    return Update(
        empty_pose(), np.zeros((BIASES, KINEMATIC)), np.zeros((BIASES, KINEMATIC)),
        np.zeros(CENTRES, dtype=np.int64), np.zeros(1, dtype=np.int64), np.zeros((CENTRES, 3)),
        np.zeros(CENTRES), np.zeros(CENTRES),
        np.zeros((rows, width)), np.zeros((KINEMATIC, rows)), np.zeros((rows, rows)),
        np.zeros(rows), np.zeros(rows), np.zeros(width), np.zeros(2),
    )  # fmt: skip


def empty_pose() -> Pose:
    """Room for a pose."""
    return Pose(np.zeros((ANGLES, 3, 3)), np.zeros((ANGLES, 3)), np.zeros((ANGLES, 3)), np.zeros((CENTRES, 3)))
