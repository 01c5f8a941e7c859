"""Which angles joint centres show at a posture. The others are estimated, but are no measurement and not to be shown.

- The rotation of a thigh or an upper arm about itself moves nothing while knee or elbow is straight.
- Near 90 deg of abduction the shoulder's first and third axis fall together.
- One collar bone of 0.17 m carries the split between clavicle and shoulder: 30 mm are 10 deg. What can be shown is the
  arm's elevation against the trunk.
"""

from collections.abc import Sequence
from math import radians

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import WHOLE_BODY, JointCentre
from services.biomech.whole_body.directions import LARGEST_DEVIATION
from services.biomech.whole_body.model import CENTRE_NAMES, DOF, WholeBodyModel
from services.biomech.whole_body.parameters import unsided

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

BENT = radians(20.0)
"""rad. From here a hinge shows the rotation of the bone above it."""
LOCKED = radians(70.0)
"""rad of ab- or adduction beyond which flexion and rotation of the shoulder merge."""

DEVIATION_SHARE = {"shoulder": 0.75, "elbow": 1.0}
OTHER_SHARE = 0.6
"""Error of an angle / deviation that the filter says. Its noise is chosen for the least error, and that is more noise
than there is: on the tuning people the error was half of it at knees, hips, pelvis and trunk, three quarters at
shoulders. With these shares 96 to 98 % of their angles lie within two deviations, of elbows 95 %. Without a standing
start, offset removed, 0.6 does for every angle (93 to 98 %)."""

_SHOWN_BY = {
    "hip_flexion": ("hip", "knee"), "hip_adduction": ("hip", "knee"), "hip_internal_rotation": ("hip", "knee", "ankle"),
    "knee_flexion": ("hip", "knee", "ankle"), "clavicle_elevation": ("shoulder",),
    "shoulder_flexion": ("shoulder", "elbow"), "shoulder_adduction": ("shoulder", "elbow"),
    "shoulder_internal_rotation": ("shoulder", "elbow", "wrist"), "elbow_flexion": ("shoulder", "elbow", "wrist"),
}  # fmt: skip
_TRUNK = (JointCentre.SPINE_BASE, JointCentre.SPINE_MID, JointCentre.SPINE_SHOULDER)


def shown_by(name: str) -> list[int]:
    """Places in JointCentre of the centres without which an angle is a guess."""
    joints = _SHOWN_BY.get(unsided(name))
    if joints is None:
        return [CENTRE_NAMES.index(centre) for centre in _TRUNK]
    side = name.rpartition("_")[2]
    return [CENTRE_NAMES.index(JointCentre(f"{joint}_{side}")) for joint in joints]


_NEEDED = np.zeros((len(WHOLE_BODY), len(CENTRE_NAMES)), dtype=np.bool_)
for _place, _dof in enumerate(WHOLE_BODY):
    _NEEDED[_place, shown_by(_dof.name)] = True
"""(22, 15) centres without which an angle is a guess."""


def _sides(name: str) -> list[int]:
    return [DOF[f"{name}_{side}"] for side in ("right", "left")]


_HIP_ROTATIONS, _KNEES = _sides("hip_internal_rotation"), _sides("knee_flexion")
_SHOULDER_ROTATIONS, _SHOULDER_FLEXIONS = _sides("shoulder_internal_rotation"), _sides("shoulder_flexion")
_ABDUCTIONS, _ELBOWS, _CLAVICLES = _sides("shoulder_adduction"), _sides("elbow_flexion"), _sides("clavicle_elevation")


def observable(angles: Array, deviations: Array, followed: Sequence[bool] | Flags) -> Flags:
    """(22,) whether each angle may be shown.

    angles (22,) rad, deviations (22,) rad; followed (15,): the camera has seen this centre in the last moments.
    """
    result = ~_NEEDED[:, ~np.asarray(followed, dtype=np.bool_)].any(axis=1)
    result &= deviations <= LARGEST_DEVIATION
    apart = np.abs(angles[_ABDUCTIONS]) < LOCKED
    result[_HIP_ROTATIONS] &= angles[_KNEES] >= BENT
    result[_SHOULDER_ROTATIONS] &= (angles[_ELBOWS] >= BENT) & apart
    result[_SHOULDER_FLEXIONS] &= apart
    result[_CLAVICLES] = False
    return np.asarray(result)


def likely_deviations(deviations: Array, *, standing: bool) -> Array:
    """(22,) rad, how far angles are likely off, from the deviations (22,) that the filter says after its start.

    Without a standing start it is how far they are off beside their constant offset, which nobody knows.
    """
    return np.asarray(deviations * (_SHARES if standing else OTHER_SHARE))


_SHARES = np.array([DEVIATION_SHARE.get(dof.name.partition("_")[0], OTHER_SHARE) for dof in WHOLE_BODY])


def arm_elevations(model: WholeBodyModel, q: Array, lengths: Array) -> Array:
    """(2,) rad, right and left: between the upper arm and the trunk's downward axis, 0 hanging, whatever lifts it."""
    pose = model.pose(q, lengths)
    down = -pose.rotation[DOF["trunk_flexion"]][:, 1]
    found = []
    for side in ("right", "left"):
        shoulder, elbow = (CENTRE_NAMES.index(JointCentre(f"{name}_{side}")) for name in ("shoulder", "elbow"))
        arm = pose.centre[elbow] - pose.centre[shoulder]
        found.append(np.arctan2(np.linalg.norm(np.cross(down, arm)), down @ arm))
    return np.array(found)


def trunk_lean(centres: Array) -> Array:
    """(..., 2) rad, forward and to the right: inclination of spine_base to spine_shoulder of centres (..., 15, 3).

    Straight from the camera: on recordings with optical truth a filter does not improve it.
    """
    bone = centres[..., CENTRE_NAMES.index(JointCentre.SPINE_SHOULDER), :] - centres[..., 0, :]
    return np.asarray(np.arctan2(bone[..., [0, 2]], bone[..., 1:2]))
