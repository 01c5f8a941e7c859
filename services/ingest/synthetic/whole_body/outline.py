"""The joints that a Kinect v2 delivers beside the centres of the body: neck, head, hands and feet."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import JointCentre, SkeletonJoint
from services.biomech.whole_body.model import CENTRE_NAMES
from services.ingest.skeleton import KINECT_V2_JOINTS
from services.ingest.synthetic.whole_body.body import Placed

Array = NDArray[np.float64]

JOINTS: tuple[SkeletonJoint, ...] = tuple(joint for joint in SkeletonJoint if joint in KINECT_V2_JOINTS)
"""All that is delivered: the fifteen centres, then the others."""
OTHERS = JOINTS[len(CENTRE_NAMES) :]

ANKLE_HEIGHT_M = 0.08
"""Of a flat foot."""
DANGLING = -0.15
"""rad, dorsiflexion of a lifted foot."""
LIFTED_FROM_M, LIFTED_TO_M = 0.01, 0.08
"""Height of an ankle over its place on the floor at which the foot begins to dangle, and does so wholly."""


class _Place(NamedTuple):
    centre: JointCentre
    offset: tuple[float, float, float]  # m in the centre's segment; z outward


_PLACES = {
    "neck": _Place(JointCentre.SPINE_SHOULDER, (0.02, 0.08, 0.0)),
    "head": _Place(JointCentre.SPINE_SHOULDER, (0.04, 0.24, 0.0)),
    "hand": _Place(JointCentre.WRIST_RIGHT, (0.0, -0.08, 0.0)),
    "hand_tip": _Place(JointCentre.WRIST_RIGHT, (0.0, -0.16, 0.0)),
    "thumb": _Place(JointCentre.WRIST_RIGHT, (0.05, -0.08, 0.0)),
    "foot": _Place(JointCentre.ANKLE_RIGHT, (0.13, -0.06, 0.0)),
}
"""Round numbers of an adult."""


class Other(NamedTuple):
    """A joint that goes with a centre."""

    centre: int  # index of the centre that it follows
    position: Array  # (n, 3) m


def others(placed: Placed, dorsiflexion: Array) -> list[Other]:
    """Those of OTHERS; dorsiflexion (n, 2) rad right and left."""
    found = []
    for joint in OTHERS:
        name = joint.removesuffix("_right").removesuffix("_left")
        place = _PLACES[name]
        side = "_left" if joint.endswith("_left") else "_right"
        m = CENTRE_NAMES.index(JointCentre(place.centre.replace("_right", side)))
        R_world_from_segment = placed.carriers[:, m]
        if name == "foot":
            R_world_from_segment = R_world_from_segment @ _pitched(dorsiflexion[:, int(side == "_left")])
        found.append(Other(m, placed.centres[:, m] + R_world_from_segment @ np.array(place.offset)))
    return found


def dorsiflexions(placed: Placed, floor_m: float) -> Array:
    """(n, 2) rad, right and left: of a foot that lies level on the floor while its ankle is low, and dangles when not.

    A shank whose y axis leans forward by b over a level foot has dorsiflexion b.
    """
    columns = []
    for centre in (JointCentre.ANKLE_RIGHT, JointCentre.ANKLE_LEFT):
        m = CENTRE_NAMES.index(centre)
        R_world_from_shank = placed.carriers[:, m]
        level = np.arctan2(-R_world_from_shank[:, 1, 0], R_world_from_shank[:, 1, 1])
        over = placed.centres[:, m, 1] - floor_m - ANKLE_HEIGHT_M
        share = np.clip((over - LIFTED_FROM_M) / (LIFTED_TO_M - LIFTED_FROM_M), 0.0, 1.0)
        lifted = share**2 * (3.0 - 2.0 * share)
        columns.append(level * (1.0 - lifted) + DANGLING * lifted)
    return np.column_stack(columns)


def _pitched(angle: Array) -> Array:
    cosine, sine = np.cos(angle), np.sin(angle)
    turned = np.zeros((len(angle), 3, 3))
    turned[:, 0, 0], turned[:, 0, 1], turned[:, 1, 0], turned[:, 1, 1], turned[:, 2, 2] = cosine, -sine, sine, cosine, 1
    return turned
