"""What every estimator of one knee says, and what it can be told."""

from math import atan2
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from services.flow.node import State

Array = NDArray[np.float64]

STEEPEST = 0.95
"""Upward part of the flexion axis above which a leg, lying on its side, has no heading."""


class KneeSample(NamedTuple):
    """One leg at one instant, rad and rad/s."""

    flexion: float  # positive when the knee bends
    flexion_std: float
    flexion_rate: float
    inclination: float  # of the thigh, forward positive, as if the pelvis were upright
    inclination_rate: float
    turn_rate: float  # of the thigh about the vertical, to the left positive
    is_known: bool  # else the angles are the last known ones


class Kept(NamedTuple):
    """Samples of both sensors, thigh first: rate rad/s (2, 3), force m/s^2 (2, 3), s since the sample before."""

    rate: Array
    force: Array
    dt_s: float


class Fitting(NamedTuple):
    """How both sensors sit on the leg."""

    R_segment_from_sensor: Array  # (2, 3, 3)
    gyro_bias: Array  # (2, 3) rad/s
    quality: float  # 0 a guess, 1 certain
    datum: str  # what zero means
    method: str


class Evidence(NamedTuple):
    """What tells how the sensors are worn, whatever was declared; all in the frame of each sensor."""

    arms: Array | None  # (2, 3) m to the knee; None where the motion has not told them
    up: Array  # (2, 3) the vertical now
    axes: Array | None  # (2, 3) flexion axes; None where posture has not told which way the knee bends


class KneeEstimator(Protocol):
    """One knee, sample by sample."""

    @property
    def kept_s(self) -> float:
        """s of samples before the angle is believed that `again` can use."""

    @property
    def is_ready(self) -> bool:
        """Whether the angle is believed."""

    @property
    def is_fitted(self) -> bool:
        """Whether there is an axis, however well it is known."""

    @property
    def wish(self) -> str:
        """What the person should do for the angle to be believed."""

    def step(self, kept: Kept) -> KneeSample | None:
        """Take one sample; None where the method gives no angle at this instant."""

    def again(self, kept: list[Kept]) -> list[KneeSample | None]:
        """The samples of before, with what is known now; their last one is the newest that `step` took."""

    def stand(self, up: Array) -> None:
        """The operator says that these verticals (2, 3) in the frame of each sensor were those of standing."""

    def finish(self) -> None:
        """The stream has ended: make do with what there is."""

    def fitting(self) -> Fitting:
        """Once it is fitted: how the sensors sit."""

    def evidence(self) -> Evidence | None:
        """After a step: what tells the placement; None for a method that is told it."""

    def snapshot(self) -> State:
        """Everything that changes."""

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`, for an estimator of the same leg."""


def frame_from_axis_and_up(flexion_axis: Array, up: Array) -> Array:
    """R_segment_from_sensor (3, 3): z against the flexion axis, which points left; y the part of `up` across it.

    Both (3,) in the sensor. Where they are parallel any direction across the axis serves.
    """
    z = -flexion_axis / np.linalg.norm(flexion_axis)
    y = up - (up @ z) * z
    if np.linalg.norm(y) < 1e-6:
        y = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
    y = y / np.linalg.norm(y)
    return np.stack([np.cross(y, z), y, z])


def thigh_motion(flexion_axis: Array, thigh_up: Array, up: Array, rate: Array) -> tuple[float, float, float]:
    """Forward inclination rad, its rate and the turn about the vertical to the left, rad/s, of a thigh.

    All (3,) in its sensor: the axis, up the segment, the vertical, and the angular velocity without bias. In the
    segment's frame Rz(a) carries the vertical (sin a, cos a, 0) to the world's y; x and y are scaled alike, which
    the angle does not see. With R = Ry(h) Rx(l) Rz(a) and c = sin l the upward part of the right axis z:
    w.y = dh + c da and w.z = c dh + da, so dh = (w.y - c w.z) / (1 - c^2). Without c a swing that leans would turn.
    Numbers, not arrays: this is done for every sample.
    """
    ax, ay, az = flexion_axis.tolist()
    sx, sy, sz = thigh_up.tolist()
    ux, uy, uz = up.tolist()
    wx, wy, wz = rate.tolist()
    along = sx * ax + sy * ay + sz * az
    yx, yy, yz = sx - along * ax, sy - along * ay, sz - along * az
    # x = y x z with z = -axis
    forward = ux * (yz * ay - yy * az) + uy * (yx * az - yz * ax) + uz * (yy * ax - yx * ay)
    inclination = atan2(forward, ux * yx + uy * yy + uz * yz)
    forward_rate, c = -(wx * ax + wy * ay + wz * az), -(ux * ax + uy * ay + uz * az)
    turn_rate = (ux * wx + uy * wy + uz * wz - c * forward_rate) / (1.0 - c * c) if abs(c) < STEEPEST else 0.0
    return inclination, forward_rate, turn_rate
