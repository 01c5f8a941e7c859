"""The same body built with Pinocchio: the oracle for our closed forms, and the source of synthetic motions."""

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from schemas.vocabulary import WHOLE_BODY, JointCentre
from services.biomech.whole_body.model import CENTRE_NAMES, DOF, WholeBodyModel

Array = NDArray[np.float64]

TRUNK = DOF["trunk_flexion"]


class PinocchioWholeBody:
    """A Pinocchio model of one person, with one frame per joint centre, named as the centre.

    With `supple` the trunk also bends to the side and twists, which our model does not know.
    """

    def __init__(self, body: WholeBodyModel, lengths: Array, *, supple: bool = False) -> None:
        self.supple = supple
        self.model = pin.Model()
        self.model.name = "whole_body"
        root = 0
        for i, name in enumerate(("pelvis_forward", "pelvis_up", "pelvis_right")):
            joint = pin.JointModelPrismaticUnaligned(np.eye(3)[i])
            root = self.model.addJoint(root, joint, pin.SE3.Identity(), name)
        tree = body.tree
        joints: list[int] = []
        for j, dof in enumerate(WHOLE_BODY):
            offset = _offset(tree.length[j], tree.along[j], tree.share[j], lengths)
            parent = root if tree.parent[j] < 0 else joints[tree.parent[j]]
            joint = pin.JointModelRevoluteUnaligned(np.array(dof.axis, dtype=np.float64))
            joints.append(self.model.addJoint(parent, joint, pin.SE3(np.eye(3), offset), dof.name))
            if supple and j == TRUNK:
                for name, axis in (("trunk_bend", np.eye(3)[0]), ("trunk_twist", np.eye(3)[1])):
                    joint = pin.JointModelRevoluteUnaligned(axis)
                    joints[-1] = self.model.addJoint(joints[-1], joint, pin.SE3.Identity(), name)
        self.frames = {}
        for m, centre in enumerate(CENTRE_NAMES):
            offset = _offset(tree.centre_length[m], tree.centre_along[m], tree.centre_share[m], lengths)
            frame = pin.Frame(centre.value, joints[tree.carrier[m]], pin.SE3(np.eye(3), offset), pin.FrameType.OP_FRAME)
            self.frames[centre] = int(self.model.addFrame(frame))
        self.data = self.model.createData()

    def centres(self, q: Array) -> Array:
        """(15, 3) m, joint centres in the world for q (25,): three translations, then 22 angles."""
        pin.framesForwardKinematics(self.model, self.data, q)
        return np.array([self.data.oMf[frame].translation for frame in self.frames.values()])

    def supple_frames(self, q: Array, bend: Array) -> tuple[Array, Array]:
        """Centres (15, 3) m and R_world_from_segment (15, 3, 3) of what carries them; bend (2,) rad aside, twist."""
        if not self.supple:
            raise ValueError("this trunk does not bend aside: build it with supple=True")
        pin.framesForwardKinematics(self.model, self.data, np.insert(q, 3 + TRUNK + 1, bend))
        placements = [self.data.oMf[frame] for frame in self.frames.values()]
        return np.array([p.translation for p in placements]), np.array([p.rotation for p in placements])

    def jacobian(self, q: Array, centre: JointCentre) -> Array:
        """(3, 25) d(centre) / dq in world axes."""
        pin.computeJointJacobians(self.model, self.data, q)
        pin.updateFramePlacements(self.model, self.data)
        J = pin.getFrameJacobian(self.model, self.data, self.frames[centre], pin.LOCAL_WORLD_ALIGNED)
        return np.array(J[:3])


def _offset(length: int, along: int, share: float, lengths: Array) -> Array:
    offset = np.zeros(3)
    if length >= 0:
        offset[along] = share * lengths[length]
    return offset
