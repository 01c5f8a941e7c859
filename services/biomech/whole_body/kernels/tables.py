"""What the kernels of the whole body work on: records, each handed on as one address.

Columns of the state: 25 coordinates (3 translations m, 22 angles rad), 12 lengths (m), then the biases of the 15
centres (45, m) where there are any, then 25 velocities and 25 accelerations. What a camera sees directly comes first
and in one piece: the Jacobian's 37 columns, and behind them one column of its own for each row.

Of the symmetric covariance P (n, M), rows as long as whole vector registers, only this is kept: all of the first 37
rows, and of the others what lies right of the diagonal. `full_covariance` gives the rest.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Record = Any
"""One element of a structured array. Compiled code reads and writes its fields as attributes."""
Table = NDArray[np.void]
"""(1,), of one of the types below."""

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
BOUNDED = ANGLES + LENGTHS
FIRST_BOUNDED = 3
"""Column of the state that the first bound is on."""
GROUP = 6
"""Rows that are fused at a time: two centres, or six priors."""
WIDEST = SEEN + BIASES + 2 * COORDINATES + 4
"""Most columns of P, filled up to whole vector registers."""


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


class Bounds(NamedTuple):
    """low <= x[3:3+b] <= high."""

    low: Array  # (b,)
    high: Array  # (b,)


def record(fields: list[tuple[Any, ...]]) -> np.dtype[np.void]:
    """A record type whose fields lie where the processor likes them."""
    return np.dtype(fields, align=True)


BODY = record([
    *((name, np.int64, (ANGLES,)) for name in ("parent", "axis", "length", "along")),
    *((name, np.float64, (ANGLES,)) for name in ("sign", "share")),
    *((name, np.int64, (CENTRES,)) for name in ("carrier", "centre_length", "centre_along", "before")),
    ("centre_share", np.float64, (CENTRES,)),
    ("columns", np.int64, (CENTRES, SEEN)),  # of the Jacobian that move a centre, the three translations first
    ("moving", np.int64, (CENTRES,)),  # how many they are
])  # fmt: skip
"""A `Tree`, and which columns of the Jacobian move each centre."""

POSE = record([
    ("rotation", np.float64, (ANGLES, 3, 3)), ("axis", np.float64, (ANGLES, 3)), ("origin", np.float64, (ANGLES, 3)),
    ("centre", np.float64, (CENTRES, 3)),
])  # fmt: skip
"""A `Pose`."""

BELIEF = record([
    ("variance", np.float64, (CENTRES,)),  # m^2 per axis of a tracked centre
    ("along", np.float64, (CENTRES,)),  # more along the bone that leads to the centre, in squares of that bone
    ("inferred", np.float64),  # factor on both of an inferred centre
    ("stretch", np.float64),  # m by which a bone may differ from the model's before its ends are doubted; 0: never
    ("gate", np.float64),  # squared innovation, in variances, from which a centre is believed less; 0: never
    ("swap_scale", np.float64),  # m
    ("swap_most", np.float64),  # squared misfit that one axis adds at most
    ("swap_share", np.float64),  # of the misfit as given that exchanged legs must undercut; 0: never
    ("density", np.float64, (COORDINATES,)),  # white jerk, rad^2/s^5 or m^2/s^5
    ("held", np.float64),  # 1: the jerk is constant over a frame and its variance given instead
    ("priors", np.int64),  # how many
    ("prior_column", np.int64, (PRIORS,)),
    ("prior_value", np.float64, (PRIORS,)),  # rad
    ("prior_variance", np.float64, (PRIORS,)),  # rad^2 of one frame of nominal length
    ("low", np.float64, (BOUNDED,)), ("high", np.float64, (BOUNDED,)),  # what is told lies within
    ("wide_low", np.float64, (BOUNDED,)), ("wide_high", np.float64, (BOUNDED,)),  # and what is carried on
])  # fmt: skip
"""What the filter believes of camera, movement and person."""

ACTIVE = record([
    ("active", np.int64, (BOUNDED,)), ("sign", np.float64, (BOUNDED,)), ("multiplier", np.float64, (BOUNDED,)),
    ("trial", np.float64, (BOUNDED,)), ("factor", np.float64, (BOUNDED, BOUNDED)),
])  # fmt: skip
"""Scratch of the projection: active bounds, +1 for a high one, their multipliers, and those that are tried."""

WORK = record([
    ("pose", POSE),
    ("bounds", ACTIVE),
    ("H", np.float64, (BIASES, KINEMATIC)),  # Jacobian of all centres
    ("expected", np.float64, (CENTRES, 3)),  # m, where the camera will see the centres, biases included
    ("innovation", np.float64, (CENTRES, 3)),  # m
    ("used", np.int64, (CENTRES,)),  # centres in use, the first `in_use`
    ("in_use", np.int64),
    ("doubt", np.float64, (CENTRES,)),  # factor on the variance of a centre at the end of a bone of wrong length
    ("R", np.float64, (CENTRES, 3, 3)),  # m^2
    ("distance", np.float64, (CENTRES,)),  # squared innovation in variances, 3 expected; of a centre in use
    ("near", np.float64, (3, KINEMATIC)),  # rows of H P, as far as the gate needs them
    ("own", np.float64, (3, 3)),  # the same, at the biases of the centre
    ("W", np.float64, (GROUP, WIDEST)),  # H P of the rows at hand, then L^-1 H P
    ("S", np.float64, (GROUP, GROUP)),  # lower triangle: their innovation covariance, then its factor L
    ("y", np.float64, (GROUP,)),
    ("dx", np.float64, (WIDEST,)),
    ("squares", np.float64),  # squared innovations of the centres, in variances
    ("log_determinant", np.float64),  # of the innovation covariance of the centres
])  # fmt: skip
"""Scratch of a frame, and what it found. Nothing here is needed by the next frame."""


def table(kind: np.dtype[np.void]) -> Table:
    """(1,) of a record, empty, where a row of the processor's cache begins."""
    return aligned(kind.itemsize, np.uint8).view(kind)


def aligned(size: int, kind: Any = np.float64) -> NDArray[Any]:
    """(size,) zeros, where a row of the processor's cache begins."""
    raw = np.zeros(size * np.dtype(kind).itemsize + 64, dtype=np.uint8)
    first = -raw.ctypes.data % 64
    return raw[first : first + size * np.dtype(kind).itemsize].view(kind)


def covariance_room(states: int) -> Array:
    """(n, M) zeros for a covariance, each row beginning with a row of the processor's cache."""
    width = states + (-states) % 8
    return aligned(states * width).reshape(states, width)


def full_covariance(kept: Array) -> Array:
    """(n, n) of a covariance (n, M) of which the upper triangle is kept."""
    upper = np.triu(kept[:, : len(kept)])
    return np.asarray(upper + np.triu(upper, 1).T)


def pose_of(posed: Table) -> Pose:
    """The arrays of a POSE."""
    return Pose(*(posed[0][name] for name in Pose._fields))
