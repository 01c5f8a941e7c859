"""Extended Kalman filter of one revolute joint with an IMU on its link (Joukov et al., eq. 4-12 for one joint).

The joint turns about a level axis; at q = 0 the link hangs straight down. The IMU sits at distance L from the axis:

    gyro        z_1 = dq                                 rad/s, about the joint axis
    radial      z_2 = -L dq^2 - g cos q                  m/s^2, specific force along the link, away from the joint
    tangential  z_3 =  L ddq + g sin q                   m/s^2, specific force in the direction of positive rotation

    x = F x + G j,   P = F P F' + G G' S,   G = (dt^3/6, dt^2/2, dt)

with x = (q, dq, ddq), j the expected jerk (0: the plain filter of (10)-(12)) and S the variance of the jerk beyond it,
S = density / dt. (13) adds the jerk to the acceleration only; here it enters velocity and position of the same
interval as well, as the process noise does.
"""

from dataclasses import dataclass
from math import cos, isfinite, log, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.single_joint.compiled import compiled

FloatArray = NDArray[np.float64]

GRAVITY = 9.81  # m/s^2
POSITION, VELOCITY, ACCELERATION = range(3)


@dataclass(frozen=True)
class JointSensor:
    """Where the IMU is and how noisy; defaults are the published simulation's."""

    offset_m: float = 0.5
    """m from the axis."""
    gyro_std: float = 0.5
    """rad/s per sample."""
    accel_std: float = 2.0
    """m/s^2 per sample."""

    @property
    def variances(self) -> FloatArray:
        """Of gyro (rad/s)^2, radial and tangential acceleration (m/s^2)^2."""
        return np.array([self.gyro_std**2, self.accel_std**2, self.accel_std**2])


class JointState(NamedTuple):
    """What changes from step to step, and room to work in."""

    x: FloatArray  # (3,) rad, rad/s, rad/s^2
    P: FloatArray  # (3, 3)
    z: FloatArray  # (3,) scratch: predicted sample
    H: FloatArray  # (3, 3) scratch: its Jacobian


def start_joint(position: float = 0.0) -> JointState:
    """At rest somewhere near `position` (rad): 0.5 rad, 3 rad/s and 30 rad/s^2 of doubt."""
    return JointState(
        x=np.array([position, 0.0, 0.0]),
        P=np.diag([0.5**2, 3.0**2, 30.0**2]),
        z=np.zeros(3),
        H=np.zeros((3, 3)),
    )


@compiled
def predict_sample(x: FloatArray, offset_m: float, z: FloatArray, H: FloatArray) -> None:
    """z (3,) and H = dz/dx (3, 3) of gyro, radial and tangential acceleration at the state x."""
    sin_q, cos_q = sin(x[POSITION]), cos(x[POSITION])
    z[0] = x[VELOCITY]
    z[1] = -offset_m * x[VELOCITY] * x[VELOCITY] - GRAVITY * cos_q
    z[2] = offset_m * x[ACCELERATION] + GRAVITY * sin_q
    H[:] = 0.0
    H[0, VELOCITY] = 1.0
    H[1, POSITION], H[1, VELOCITY] = GRAVITY * sin_q, -2.0 * offset_m * x[VELOCITY]
    H[2, POSITION], H[2, ACCELERATION] = GRAVITY * cos_q, offset_m


@compiled
def predict_state(x: FloatArray, jerk: float, dt_s: float) -> None:
    """x = F x + G j."""
    acceleration = x[ACCELERATION]
    x[POSITION] += dt_s * (x[VELOCITY] + dt_s * (acceleration / 2.0 + dt_s * jerk / 6.0))
    x[VELOCITY] += dt_s * (acceleration + dt_s * jerk / 2.0)
    x[ACCELERATION] += dt_s * jerk


@compiled
def predict_covariance(P: FloatArray, jerk_density: float, dt_s: float) -> None:
    """P = F P F' + G G' density / dt."""
    half = 0.5 * dt_s * dt_s
    for c in range(3):
        P[0, c] += dt_s * P[1, c] + half * P[2, c]
        P[1, c] += dt_s * P[2, c]
    for r in range(3):
        P[r, 0] += dt_s * P[r, 1] + half * P[r, 2]
        P[r, 1] += dt_s * P[r, 2]
    g = (dt_s * dt_s * dt_s / 6.0, half, dt_s)
    for r in range(3):
        for c in range(3):
            P[r, c] += g[r] * g[c] * jerk_density / dt_s


@compiled
def fuse_row(x: FloatArray, P: FloatArray, h: FloatArray, innovation: float, variance: float) -> float:
    """One scalar measurement with Jacobian h (3,); returns the variance of its innovation."""
    ph_0 = P[0, 0] * h[0] + P[0, 1] * h[1] + P[0, 2] * h[2]
    ph_1 = P[1, 0] * h[0] + P[1, 1] * h[1] + P[1, 2] * h[2]
    ph_2 = P[2, 0] * h[0] + P[2, 1] * h[1] + P[2, 2] * h[2]
    ph = (ph_0, ph_1, ph_2)
    s = h[0] * ph_0 + h[1] * ph_1 + h[2] * ph_2 + variance
    for r in range(3):
        x[r] += ph[r] * innovation / s
        for c in range(3):
            P[r, c] -= ph[r] * ph[c] / s
    variance_seen: float = s
    return variance_seen


@compiled
def fuse_sample(joint: JointState, sample: FloatArray, variances: FloatArray, offset_m: float) -> tuple[float, float]:
    """Fuse gyro, radial and tangential acceleration.

    Returns the normalised innovation squared and the logarithm of the determinant of the innovation covariance; their
    sum is -2 log likelihood of the sample, up to a constant.

    One row after the other, all linearised at the predicted state, which gives the same as all at once.
    Components that are not finite are left out.
    """
    x, P, z, H = joint
    predict_sample(x, offset_m, z, H)
    before_0, before_1, before_2 = x[0], x[1], x[2]
    squared, log_determinant = 0.0, 0.0
    for i in range(3):
        if isfinite(sample[i]):
            moved = H[i, 0] * (x[0] - before_0) + H[i, 1] * (x[1] - before_1) + H[i, 2] * (x[2] - before_2)
            innovation = sample[i] - z[i] - moved
            variance = fuse_row(x, P, H[i], innovation, variances[i])
            squared += innovation * innovation / variance
            log_determinant += log(variance)
    return squared, log_determinant


@compiled
def advance_joint(
    joint: JointState,
    sample: FloatArray,
    dt_s: float,
    jerk: float,
    jerk_density: float,
    variances: FloatArray,
    offset_m: float,
) -> tuple[float, float]:
    """Predict over dt_s with the expected jerk, fuse the sample; returns as `fuse_sample`."""
    predict_state(joint.x, jerk, dt_s)
    predict_covariance(joint.P, jerk_density, dt_s)
    return fuse_sample(joint, sample, variances, offset_m)


class SingleJointEkf:
    """The filter of one joint, one sample at a time (equations at the head of this file)."""

    def __init__(self, jerk_density: float, sensor: JointSensor = JointSensor(), position: float = 0.0) -> None:
        """`jerk_density` in rad^2/s^5; starts at rest near `position`, rad."""
        self.sensor, self.jerk_density = sensor, jerk_density
        self._joint = start_joint(position)
        self._variances = sensor.variances

    @property
    def x(self) -> FloatArray:
        """Position rad, velocity rad/s, acceleration rad/s^2, shape (3,)."""
        return self._joint.x

    @property
    def P(self) -> FloatArray:
        """Covariance of `x`, shape (3, 3)."""
        return self._joint.P

    def step(self, sample: FloatArray, dt_s: float, jerk: float = 0.0) -> float:
        """Take one sample.

        Args:
            sample: gyro rad/s, radial and tangential specific force m/s^2, shape (3,); not finite = missing.
            dt_s: s since the sample before, > 0.
            jerk: rad/s^3 expected over that time.

        Returns:
            Normalised innovation squared; its mean is 3 where the filter's noise is right.
        """
        squared, _ = advance_joint(
            self._joint, sample, dt_s, jerk, self.jerk_density, self._variances, self.sensor.offset_m
        )
        return float(squared)
