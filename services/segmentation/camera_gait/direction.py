"""Where a person walks to, out of joint centres in the room."""

import math
from typing import NamedTuple

from services.flow.node import State
from services.segmentation.camera_gait.parameters import CameraGaitParameters

Floor = tuple[float, float]
"""m along x and z of the room."""


class Walker(NamedTuple):
    """What of the joint centres matters at one time, each m along x and z of the room."""

    pelvis: Floor
    ankles: tuple[Floor, Floor]  # left, right
    to_the_right: Floor  # from left to right hip and shoulder, added up


class WalkingDirection:
    """The line along which the ankles part, forward as hips and shoulders face.

    The ankles' difference, exponentially weighted over some seconds about its mean, has its principal axis along the
    way, with or without a treadmill: its swing of half a metre outweighs the camera's errors, while hips alone,
    0.2 m apart and each some centimetres off, may be 10 deg wrong. As long as the ankles hardly part it is where the
    person faces.
    """

    def __init__(self, parameters: CameraGaitParameters) -> None:
        self._parameters = parameters
        self._last_ns: int | None = None
        self._facing = (1.0, 0.0)
        self._mean = (0.0, 0.0)
        self._spread = (0.0, 0.0, 0.0)  # m^2, xx, xz and zz

    def step(self, captured_ns: int, walker: Walker) -> Floor:
        """Take one sample; the unit vector forward, along x and z."""
        p = self._parameters
        since_s = 0.0 if self._last_ns is None else (captured_ns - self._last_ns) / 1e9
        # Up (y) cross right: (z, 0, -x) of the vector to the right.
        self._follow_facing((walker.to_the_right[1], -walker.to_the_right[0]), since_s)
        left, right = walker.ankles
        apart = right[0] - left[0], right[1] - left[1]
        keep = math.exp(-since_s / p.direction_s)
        if self._last_ns is None:
            self._mean = apart
        dx, dz = apart[0] - self._mean[0], apart[1] - self._mean[1]
        take = 1.0 - keep
        self._mean = self._mean[0] + take * dx, self._mean[1] + take * dz
        xx, xz, zz = self._spread
        self._spread = keep * (xx + take * dx * dx), keep * (xz + take * dx * dz), keep * (zz + take * dz * dz)
        self._last_ns = captured_ns
        return self._axis()

    def _follow_facing(self, facing: Floor, since_s: float) -> None:
        size = math.hypot(*facing)
        if size < 1e-6:
            return
        take = 1.0 if self._last_ns is None else 1.0 - math.exp(-since_s / self._parameters.facing_s)
        x, z = (old + take * (new / size - old) for old, new in zip(self._facing, facing, strict=True))
        # Half a turn passes through nothing; any sample then says more than the past.
        size = math.hypot(x, z)
        self._facing = (x / size, z / size) if size > 1e-6 else self._facing

    def _axis(self) -> Floor:
        fx, fz = self._facing
        weight = self._parameters.facing_weight_m**2
        xx, xz, zz = self._spread
        xx, xz, zz = xx + weight * fx * fx, xz + weight * fx * fz, zz + weight * fz * fz
        turned = 0.5 * math.atan2(2.0 * xz, xx - zz)
        x, z = math.cos(turned), math.sin(turned)
        return (x, z) if x * fx + z * fz >= 0.0 else (-x, -z)

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "last_ns": self._last_ns,
            "facing": list(self._facing),
            "mean": list(self._mean),
            "spread": list(self._spread),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._last_ns = state["last_ns"]
        self._facing = (state["facing"][0], state["facing"][1])
        self._mean = (state["mean"][0], state["mean"][1])
        xx, xz, zz = state["spread"]
        self._spread = (xx, xz, zz)
