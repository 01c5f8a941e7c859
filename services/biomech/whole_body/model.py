"""The whole body as a tree of 22 hinges and 12 lengths, and the 15 joint centres a depth camera sees on it.

Colombel et al. 2020, figure 1. Frames are ISB (x forward, y up, z right); the root is the centre `spine_base`, which
carries three translations beside the 22 angles, so that no centre's noise is spread over the others. Hips and
spine_base lie on one line: a trunk that bent there would leave pelvis tilt, hip flexion and trunk flexion undetermined,
so it bends at spine_mid, and hip flexion is that of the thigh against the lower trunk.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import WHOLE_BODY, JointCentre
from services.biomech.whole_body.directions import TRUNK_JOINT
from services.biomech.whole_body.kernels.kinematics import differentiate_alone, place_alone
from services.biomech.whole_body.kernels.tables import (
    BODY,
    CENTRES,
    COORDINATES,
    KINEMATIC,
    LENGTHS,
    POSE,
    Pose,
    Table,
    Tree,
    pose_of,
    table,
)

Array = NDArray[np.float64]

LENGTH_NAMES = (
    "half_pelvis", "thigh_right", "thigh_left", "shank_right", "shank_left", "trunk", "clavicle_right",
    "clavicle_left", "upper_arm_right", "upper_arm_left", "forearm_right", "forearm_left",
)  # fmt: skip
"""L1 to L12 of the paper; `trunk` reaches from spine_base to spine_shoulder."""

CENTRE_NAMES = tuple(JointCentre)
DOF = {dof.name: i for i, dof in enumerate(WHOLE_BODY)}
"""Name of an angle -> its place among the 22."""

PARTNERS = ((1, 2), (3, 4), (6, 7), (8, 9), (10, 11))
"""Lengths of the right and the left side."""

_X, _Y, _Z = 0, 1, 2


class Offset(NamedTuple):
    """Where something sits in its carrier's frame: a share of a length, along a coordinate axis."""

    length: str | None
    axis: int = _Y
    share: float = 1.0


def _joint_offsets(trunk_joint: float) -> dict[str, tuple[str, Offset]]:
    """First angle of each joint -> (last angle of the segment that carries it, where on that segment)."""
    offsets = {
        "trunk_flexion": ("pelvis_obliquity", Offset("trunk", _Y, trunk_joint)),
    }
    for side, right in (("right", 1.0), ("left", -1.0)):
        offsets |= {
            f"hip_flexion_{side}": ("pelvis_obliquity", Offset("half_pelvis", _Z, right)),
            f"knee_flexion_{side}": (f"hip_internal_rotation_{side}", Offset(f"thigh_{side}", _Y, -1.0)),
            f"clavicle_elevation_{side}": ("trunk_flexion", Offset("trunk", _Y, 1.0 - trunk_joint)),
            f"shoulder_flexion_{side}": (f"clavicle_elevation_{side}", Offset(f"clavicle_{side}", _Z, right)),
            f"elbow_flexion_{side}": (f"shoulder_internal_rotation_{side}", Offset(f"upper_arm_{side}", _Y, -1.0)),
        }
    return offsets


def _centre_offsets(trunk_joint: float) -> dict[JointCentre, tuple[str, Offset]]:
    """Centre -> (last angle of the segment that carries it, where on that segment)."""
    offsets = {
        JointCentre.SPINE_BASE: ("pelvis_obliquity", Offset(None)),
        JointCentre.SPINE_MID: ("pelvis_obliquity", Offset("trunk", _Y, trunk_joint)),
        JointCentre.SPINE_SHOULDER: ("trunk_flexion", Offset("trunk", _Y, 1.0 - trunk_joint)),
    }
    for side, right in (("right", 1.0), ("left", -1.0)):
        offsets |= {
            JointCentre(f"shoulder_{side}"): (f"clavicle_elevation_{side}", Offset(f"clavicle_{side}", _Z, right)),
            JointCentre(f"elbow_{side}"): (
                f"shoulder_internal_rotation_{side}",
                Offset(f"upper_arm_{side}", _Y, -1.0),
            ),
            JointCentre(f"wrist_{side}"): (f"elbow_flexion_{side}", Offset(f"forearm_{side}", _Y, -1.0)),
            JointCentre(f"hip_{side}"): ("pelvis_obliquity", Offset("half_pelvis", _Z, right)),
            JointCentre(f"knee_{side}"): (f"hip_internal_rotation_{side}", Offset(f"thigh_{side}", _Y, -1.0)),
            JointCentre(f"ankle_{side}"): (f"knee_flexion_{side}", Offset(f"shank_{side}", _Y, -1.0)),
        }
    return offsets


def previous_centres() -> dict[JointCentre, JointCentre]:
    """Centre -> the centre at the other end of the bone that leads to it."""
    previous = {
        JointCentre.SPINE_MID: JointCentre.SPINE_BASE,
        JointCentre.SPINE_SHOULDER: JointCentre.SPINE_MID,
    }
    for side in ("right", "left"):
        chain = [
            JointCentre.SPINE_SHOULDER,
            *(JointCentre(f"{name}_{side}") for name in ("shoulder", "elbow", "wrist")),
        ]
        previous |= dict(zip(chain[1:], chain[:-1], strict=True))
        chain = [JointCentre.SPINE_BASE, *(JointCentre(f"{name}_{side}") for name in ("hip", "knee", "ankle"))]
        previous |= dict(zip(chain[1:], chain[:-1], strict=True))
    return previous


@dataclass(frozen=True)
class WholeBodyModel:
    """The body in the order of the vocabulary's WHOLE_BODY, LENGTH_NAMES and JointCentre.

    Coordinates q (25,): three translations of spine_base in the world, m, then the 22 angles, rad. Lengths (12,) m.
    """

    trunk_joint: float = TRUNK_JOINT

    @cached_property
    def tree(self) -> Tree:
        """Joints and centres."""
        axes = np.array([dof.axis for dof in WHOLE_BODY], dtype=np.float64)
        axis = np.abs(axes).argmax(axis=1)
        parent = np.arange(-1, len(WHOLE_BODY) - 1)
        joint_offsets = {name: Offset(None) for name in DOF}
        for name, (carrier, offset) in _joint_offsets(self.trunk_joint).items():
            parent[DOF[name]] = DOF[carrier]
            joint_offsets[name] = offset
        centres = _centre_offsets(self.trunk_joint)
        carriers = np.array([DOF[centres[centre][0]] for centre in CENTRE_NAMES])
        previous = previous_centres()
        before = np.array([CENTRE_NAMES.index(previous[c]) if c in previous else -1 for c in CENTRE_NAMES])
        return Tree(
            parent, axis, axes[np.arange(len(axis)), axis].copy(), *_offset_table(list(joint_offsets.values())),
            carriers, *_offset_table([centres[centre][1] for centre in CENTRE_NAMES]), before,
        )  # fmt: skip

    @cached_property
    def body(self) -> Table:
        """(1,) BODY, as the kernels take it.

        Which of the 37 columns [q, lengths] move a centre is told by the derivative at a posture without symmetry; an
        axial rotation, say, never moves the end of its bone.
        """
        body, generator = self._untouched_body(), np.random.default_rng(1)
        H = self._jacobian(generator.uniform(0.2, 0.8, COORDINATES), generator.uniform(0.2, 0.5, LENGTHS), body)
        touched = np.abs(H).max(axis=1) > 1e-9
        body["moving"][0] = touched.sum(axis=1)
        for row, used in zip(body["columns"][0], touched, strict=True):
            row[: used.sum()] = np.flatnonzero(used)
        return body

    def _untouched_body(self) -> Table:
        body = table(BODY)
        for name, values in self.tree._asdict().items():
            body[name][0] = values
        return body

    def pose(self, q: Array, lengths: Array) -> Pose:
        """Rotations, axes, joint origins and centres, see `Pose`."""
        posed = table(POSE)
        place_alone(np.ascontiguousarray(q), np.ascontiguousarray(lengths), self.body, posed)
        return pose_of(posed)

    def centres(self, q: Array, lengths: Array) -> Array:
        """(15, 3) m, joint centres in the world."""
        return self.pose(q, lengths).centre

    def jacobian(self, q: Array, lengths: Array) -> Array:
        """(15, 3, 37) d(centre) / d[q, lengths].

        d(centre)/d(angle) = a x r with the joint's axis a and r from the joint to the centre; d(centre)/d(length) is
        the sum of the unit vectors, times their share, along which that length lies on the way from the root.
        """
        return self._jacobian(q, lengths, self.body)

    def _jacobian(self, q: Array, lengths: Array, body: Table) -> Array:
        posed, H = table(POSE), np.zeros((3 * CENTRES, KINEMATIC))
        place_alone(np.ascontiguousarray(q), np.ascontiguousarray(lengths), body, posed)
        differentiate_alone(body, posed, H)
        return H.reshape(CENTRES, 3, KINEMATIC)[:, :, : COORDINATES + LENGTHS]


MODEL = WholeBodyModel()
"""The body as people are built on average."""


def _offset_table(offsets: list[Offset]) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
    length = [-1 if offset.length is None else LENGTH_NAMES.index(offset.length) for offset in offsets]
    return (
        np.array(length), np.array([offset.axis for offset in offsets]), np.array([offset.share for offset in offsets])
    )  # fmt: skip
