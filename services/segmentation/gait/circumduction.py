"""How far a foot swings outward, from the joint angles of a stride."""

import numpy as np
from numpy.typing import NDArray

from schemas.session import Anthropometry
from schemas.vocabulary import Side
from services.segmentation.batch import DOFS
from services.segmentation.gait.history import HEADING, Span
from services.segmentation.gait.leg_kinematics import SIDES, leg_motion
from services.segmentation.gait.step_length import NEEDED

Array = NDArray[np.float64]

LEAST_WAY_M = 0.05
"""m between the contacts, below which no line between them has a direction."""


def circumduction(side: Side, standing: Span, body: Anthropometry) -> float | None:
    """m, largest outward distance of the ankle from the straight line between its two places on the ground.

    `standing` reaches from the other foot's contact to this foot's contact at the end of the stride: all that time the
    other foot stands, so this ankle's place relative to that one is its place in the room, but for what the standing
    foot rolls forward. At its beginning this foot still stands where it had come down. 0 where the ankle only swings
    inward; None when an angle is not valid or the foot hardly went anywhere.
    """
    if not standing.valid[NEEDED].all():
        return None
    position = standing.position[:, :DOFS]
    ankle = leg_motion(position, np.zeros_like(position), body).ankle
    own = SIDES.index(side)
    place = _in_the_room(ankle[..., own] - ankle[..., 1 - own], position[:, HEADING])
    ends = [np.interp([standing.start_ns, standing.end_ns], standing.captured_ns, column) for column in place]
    (x0, x1), (z0, z1) = ends
    way = float(np.hypot(x1 - x0, z1 - z0))
    if way < LEAST_WAY_M:
        return None
    # To the right of the way (dx, dz) points (-dz, dx), for z is to the right of x.
    to_the_right = ((x1 - x0) * (place[1] - z0) - (z1 - z0) * (place[0] - x0)) / way
    outward = to_the_right if side is Side.RIGHT else -to_the_right
    return max(0.0, float(outward.max()))


def _in_the_room(vectors: Array, heading: Array) -> Array:
    """(2, n) m along x and z of the room, of vectors (3, n) in the heading frames."""
    # Turned to the left by a, forward is (cos a, 0, -sin a) and right (sin a, 0, cos a).
    cos, sin = np.cos(heading), np.sin(heading)
    return np.stack([cos * vectors[0] + sin * vectors[2], cos * vectors[2] - sin * vectors[0]])
