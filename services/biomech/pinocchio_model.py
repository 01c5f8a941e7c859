"""The same body built with Pinocchio: the oracle for our closed forms, and the model for export.

Pinocchio's quantities are ours: joints in the order of `LowerBodyModel.dofs`, metres, radians, world y up. It is too
slow for the filter (some hundred microseconds a step through Python), so nothing live imports this module.
"""

from collections.abc import Sequence

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from schemas.vocabulary import Segment
from services.biomech.bones import SEGMENTS
from services.biomech.lower_body import DEFAULT_POSITION, LowerBodyModel, SensorMount

Array = NDArray[np.float64]

GRAVITY = 9.81


class PinocchioBody:
    """A Pinocchio model with one frame per segment (named as the segment), per ankle and per sensor."""

    def __init__(self, body: LowerBodyModel, mounts: Sequence[SensorMount] = ()) -> None:
        self.body = body
        self.model = pin.Model()
        self.model.name = "lower_body"
        parent = body.body.parent
        for j, dof in enumerate(body.dofs):
            joint = _joint(np.array(dof.axis, dtype=np.float64), is_translation=j < body.first_rotation)
            placement = pin.SE3(np.eye(3), body.body.offset[j])
            self.model.addJoint(int(parent[j]) + 1, joint, placement, dof.name)
        self.segment_frames = {s: self._frame(s.value, s, pin.SE3.Identity()) for s in SEGMENTS}
        self.ankle_frames = {s: self._ankle(s) for s in (Segment.SHANK_RIGHT, Segment.SHANK_LEFT)}
        self.sensor_frames = [self._sensor(i, mount) for i, mount in enumerate(mounts)]
        self.data = self.model.createData()

    def _frame(self, name: str, segment: Segment, placement: pin.SE3) -> int:
        joint = self.body.last_joint(segment) + 1
        return int(self.model.addFrame(pin.Frame(name, joint, placement, pin.FrameType.OP_FRAME)))

    def _ankle(self, shank: Segment) -> int:
        down = np.array([0.0, -self.body.anthropometry.shank_length_m, 0.0])
        return self._frame(shank.value.replace("shank", "ankle"), shank, pin.SE3(np.eye(3), down))

    def _sensor(self, index: int, mount: SensorMount) -> int:
        position = np.array(mount.position or DEFAULT_POSITION[mount.segment])
        return self._frame(f"sensor_{index}", mount.segment, pin.SE3(mount.R_segment_from_sensor, position))

    def segment_pose(self, segment: Segment, position: Array) -> tuple[Array, Array]:
        """R_world_from_segment (3, 3) and the proximal joint in the world (3,), for joint coordinates (n,)."""
        pin.framesForwardKinematics(self.model, self.data, position)
        placement = self.data.oMf[self.segment_frames[segment]]
        return placement.rotation.copy(), placement.translation.copy()

    def ankle_position(self, shank: Segment, position: Array) -> Array:
        """Ankle centre in the world, (3,) m."""
        pin.framesForwardKinematics(self.model, self.data, position)
        return np.array(self.data.oMf[self.ankle_frames[shank]].translation)

    def sample(self, index: int, x: Array) -> Array:
        """What sensor `index` measures in state x (3, n): rad/s and m/s^2, (6,), sensor frame.

        The specific force of every sensor is that of a world which accelerates upwards by g.
        """
        pin.forwardKinematics(self.model, self.data, x[0], x[1], x[2])
        pin.updateFramePlacements(self.model, self.data)
        frame = self.sensor_frames[index]
        rate = pin.getFrameVelocity(self.model, self.data, frame, pin.LOCAL).angular
        acceleration = pin.getFrameClassicalAcceleration(self.model, self.data, frame, pin.LOCAL).linear
        up = np.array([0.0, GRAVITY, 0.0])
        return np.concatenate([rate, acceleration + self.data.oMf[frame].rotation.T @ up])

    def sample_jacobian(self, index: int, x: Array) -> tuple[Array, Array]:
        """`sample` and its derivatives (6, 3, n) by position, velocity and acceleration."""
        self.differentiate(x)
        return self.differentiated_sample(index)

    def differentiate(self, x: Array) -> None:
        """Derivatives of all joints in state x (3, n), for `differentiated_sample`."""
        pin.computeForwardKinematicsDerivatives(self.model, self.data, x[0], x[1], x[2])
        pin.updateFramePlacements(self.model, self.data)

    def differentiated_sample(self, index: int) -> tuple[Array, Array]:
        """`sample_jacobian` of the state that was differentiated last.

        Gravity cannot be folded into the root, since a model without translations has no root joint that could
        accelerate: its part of the derivative, skew(R' g) d(angular), is added. The classical acceleration is the
        spatial one plus w x u, so its derivative gains W du - U dw.
        """
        model, data, frame = self.model, self.data, self.sensor_frames[index]
        v_q, a_q, a_v, a_a = pin.getFrameAccelerationDerivatives(model, data, frame, pin.LOCAL)
        velocity = pin.getFrameVelocity(model, data, frame, pin.LOCAL)
        spatial = pin.getFrameAcceleration(model, data, frame, pin.LOCAL)
        w, u = velocity.angular, velocity.linear
        W, U = pin.skew(w), pin.skew(u)
        gravity = data.oMf[frame].rotation.T @ np.array([0.0, GRAVITY, 0.0])
        H = np.zeros((6, 3, model.nv))
        H[:3, 0], H[:3, 1] = v_q[3:], a_a[3:]
        H[3:, 0] = a_q[:3] + W @ v_q[:3] - U @ v_q[3:] + pin.skew(gravity) @ a_a[3:]
        H[3:, 1] = a_v[:3] + W @ a_a[:3] - U @ a_a[3:]
        H[3:, 2] = a_a[:3]
        return np.concatenate([w, spatial.linear + W @ u + gravity]), H

    def yaw(self, segment: Segment, position: Array) -> tuple[float, Array]:
        """Heading of a segment's forward axis, rad, positive to the left, and its derivative (n,)."""
        pin.computeJointJacobians(self.model, self.data, position)
        pin.updateFramePlacements(self.model, self.data)
        frame = self.segment_frames[segment]
        R = self.data.oMf[frame].rotation
        angular = pin.getFrameJacobian(self.model, self.data, frame, pin.LOCAL_WORLD_ALIGNED)[3:]
        d = -pin.skew(R[:, 0]) @ angular
        flat = R[0, 0] ** 2 + R[2, 0] ** 2
        return float(np.arctan2(-R[2, 0], R[0, 0])), (R[2, 0] * d[0] - R[0, 0] * d[2]) / flat


def _joint(axis: Array, *, is_translation: bool) -> pin.JointModel:
    if is_translation:
        return pin.JointModelPrismaticUnaligned(axis)
    return pin.JointModelRevoluteUnaligned(axis)
