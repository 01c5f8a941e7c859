"""Where joint centres are: as a camera session tells them, else by forward kinematics of the lower body.

The body model is imported where it is used: it brings a compiler, which the gateway need not load to start.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.session import Anthropometry
from schemas.vocabulary import LOWER_BODY, JointCentre, Segment
from services.exports.motion import Array, Motion, Track
from services.exports.parameters import ROWS_AT_A_TIME

IN_ROOM = "in the room of the camera, y up"
AT_PELVIS = (
    "midpoint of the hip centres at the origin, for inertial sensors do not tell where a person is; "
    "x forward as the person stood, y up, z right; lengths of segments as given for the session"
)
LEG_CENTRES = (
    JointCentre.HIP_RIGHT,
    JointCentre.KNEE_RIGHT,
    JointCentre.ANKLE_RIGHT,
    JointCentre.HIP_LEFT,
    JointCentre.KNEE_LEFT,
    JointCentre.ANKLE_LEFT,
)
BONES: tuple[tuple[JointCentre, JointCentre], ...] = (
    (JointCentre.HIP_RIGHT, JointCentre.HIP_LEFT),
    *((JointCentre(f"hip_{side}"), JointCentre(f"knee_{side}")) for side in ("right", "left")),
    *((JointCentre(f"knee_{side}"), JointCentre(f"ankle_{side}")) for side in ("right", "left")),
    (JointCentre.SPINE_BASE, JointCentre.SPINE_MID),
    (JointCentre.SPINE_MID, JointCentre.SPINE_SHOULDER),
    *((JointCentre.SPINE_SHOULDER, JointCentre(f"shoulder_{side}")) for side in ("right", "left")),
    *((JointCentre(f"shoulder_{side}"), JointCentre(f"elbow_{side}")) for side in ("right", "left")),
    *((JointCentre(f"elbow_{side}"), JointCentre(f"wrist_{side}")) for side in ("right", "left")),
)
"""What a line connects in a picture."""


class Positions(NamedTuple):
    """Centres over time: (n, m, 3) m, world axes x forward, y up, z right, and in words where the origin is."""

    names: tuple[JointCentre, ...]
    track: Track
    origin: str


def joint_positions(motion: Motion, anthropometry: Anthropometry) -> Positions | None:
    """None where neither a camera tells positions nor both hips and knees of a leg their angles."""
    if motion.centres is not None:
        return Positions(tuple(JointCentre), motion.centres, IN_ROOM)
    if motion.model != "lower_body" or not any(_follows(motion.told, side) for side in ("right", "left")):
        return None
    return Positions(LEG_CENTRES, leg_track(motion.angles, motion.told, anthropometry), AT_PELVIS)


def leg_track(angles: Track, told: frozenset[str], anthropometry: Anthropometry) -> Track:
    """Centres of LEG_CENTRES for the angles of LOWER_BODY, those that are not told at zero."""
    names = [freedom.name for freedom in LOWER_BODY]
    known = np.array([name in told for name in names])
    valid = []
    for side in ("right", "left"):
        hip, knee = (angles.valid[:, names.index(f"{name}_flexion_{side}")] for name in ("hip", "knee"))
        hip = hip & _follows(told, side)
        valid += [angles.valid.any(axis=1), hip, hip & knee]
    flags = np.stack(valid, axis=1)
    points = np.zeros((*flags.shape, 3))
    for first in range(0, len(points), ROWS_AT_A_TIME):
        some = slice(first, first + ROWS_AT_A_TIME)
        points[some] = _leg_points(np.where(known, angles.value[some, :, 0], 0.0), anthropometry)
    points[~flags] = 0.0
    return Track(angles.times_ns, points, flags)


def _leg_points(position: Array, anthropometry: Anthropometry) -> Array:
    """(n, 6, 3) m of LEG_CENTRES for (n, 15) rad."""
    from services.biomech.lower_body import LowerBodyModel

    model = LowerBodyModel(anthropometry)
    rotation, origin = leg_poses(position, anthropometry)
    points = []
    for side in ("right", "left"):
        thigh, shank = (model.last_joint(Segment(f"{name}_{side}")) for name in ("thigh", "shank"))
        ankle = origin[:, shank] - anthropometry.shank_length_m * rotation[:, shank, :, 1]
        points += [origin[:, thigh], origin[:, shank], ankle]
    return np.stack(points, axis=1)


def leg_poses(position: Array, anthropometry: Anthropometry) -> tuple[Array, Array]:
    """Frames behind each of LOWER_BODY's joints for (n, 15) rad: rotation (n, 15, 3, 3) and origin (n, 15, 3) m.

    R_j = R_parent Rot(e_j, q_j), o_j = o_parent + R_parent r_j, all samples at a time.
    """
    from services.biomech.lower_body import LowerBodyModel

    body = LowerBodyModel(anthropometry).body
    n, joints = position.shape
    rotation, origin = np.empty((n, joints, 3, 3)), np.empty((n, joints, 3))
    for j in range(joints):
        parent = int(body.parent[j])
        carrier = rotation[:, parent] if parent >= 0 else np.broadcast_to(np.eye(3), (n, 3, 3))
        start = origin[:, parent] if parent >= 0 else np.zeros(3)
        origin[:, j] = start + carrier @ body.offset[j]
        rotation[:, j] = carrier @ rotation_about(int(body.axis[j]), body.sign[j] * position[:, j])
    return rotation, origin


def rotation_about(axis: int, angle: NDArray[np.float64]) -> Array:
    """(n, 3, 3) rotations by (n,) rad about a coordinate axis: 0 x, 1 y, 2 z."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    R = np.zeros((angle.size, 3, 3))
    R[:, axis, axis] = 1.0
    R[:, u, u] = R[:, v, v] = np.cos(angle)
    R[:, v, u] = np.sin(angle)
    R[:, u, v] = -R[:, v, u]
    return R


def _follows(told: frozenset[str], side: str) -> bool:
    return {f"hip_flexion_{side}", f"knee_flexion_{side}"} <= told
