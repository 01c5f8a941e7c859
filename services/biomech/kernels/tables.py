"""The arrays that the kernels work on, by what they describe. Shapes: n joints, t of them translations, r rotations,
S sensors, N = 3 r + t states with a covariance.

Joints are ordered from the root outwards, translations first. The state is x (3, n): position, velocity and
acceleration of each joint. Columns of the covariance: rotation i has columns i, r + i and 2 r + i for position,
velocity and acceleration; translation k has column 3 r + k for its acceleration alone, because no inertial sensor
sees where the pelvis is or how fast it travels. The covariance, and every row that multiplies it, is M >= N long;
the columns behind N stay zero and let the compiler run over whole vector registers.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.kernels.fixed import Width

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]

REGISTER = 8
"""Doubles in the widest vector register."""


class Body(NamedTuple):
    """Tree of one-axis joints."""

    parent: Indices  # (n,) joint that carries this one, -1 for the world
    axis: Indices  # (n,) coordinate axis of the parent frame: 0 x, 1 y, 2 z
    sign: Array  # (n,) +1 or -1: direction along that axis
    offset: Array  # (n, 3) m, origin of the joint in the parent's frame
    translations: int  # t


class Sensors(NamedTuple):
    """Where the sensors sit."""

    joint: Indices  # (S,) last joint of the sensor's segment
    rotation: Array  # (S, 3, 3) R_segment_from_sensor
    position: Array  # (S, 3) m, in the segment's frame from its proximal joint
    path: Indices  # (S, deepest) joints from the root to the segment
    path_length: Indices  # (S,)


class Columns(NamedTuple):
    """Which columns of the covariance each kind of row touches, in threes: filled up with columns it does not touch."""

    gyro: Indices  # (S, N)
    gyro_count: Indices  # (S,)
    accel: Indices  # (S, N)
    accel_count: Indices  # (S,)
    yaw: Indices  # positions of pelvis and hips
    complete: int  # rows before this one are touched; those behind matter only through the prediction


class Options(NamedTuple):
    """What the measurement model is made of; see LowerBodyOptions for why."""

    gyro_sees_position: bool
    accel_sees_motion: bool
    yaw_mode: int  # 0 none, 1 each segment against the world, 2 thighs against the pelvis
    yaw_bodies: Indices  # (3,) last joint of pelvis, right thigh, left thigh
    force_bound: float  # m/s^2, longest specific force that is believed


class Noise(NamedTuple):
    """How much is believed, as variances."""

    jerk: Array  # (n,) rad^2/s^5 white jerk; translations m^2/s^5
    sample: Array  # (S, 6) rad^2/s^2 three times, m^2/s^4 three times
    yaw: float  # rad^2
    impact_rate: float  # rad/s, innovation beyond which the jerk is widened
    impact_deviations: float  # standard deviations that are left of such an innovation


class Motion(NamedTuple):
    """Scratch: what the recursion over the joints finds, in world axes."""

    rotation: Array  # (n, 3, 3) R_world_from_segment behind each joint
    axis: Array  # (n, 3) joint axis, positive direction
    rate: Array  # (n, 3) rad/s angular velocity behind the joint
    axis_rate: Array  # (n, 3) first derivative of the axis
    axis_acceleration: Array  # (n, 3) second derivative of the axis
    angular_acceleration: Array  # (n, 3) rad/s^2 behind the joint
    origin: Array  # (n, 3) m
    origin_velocity: Array  # (n, 3) m/s
    origin_acceleration: Array  # (n, 3) m/s^2


def empty_motion(joints: int) -> Motion:
    """Room for n joints."""
    a, b, c, d, e, f, g, h = (np.zeros((joints, 3)) for _ in range(8))
    return Motion(np.zeros((joints, 3, 3)), a, b, c, d, e, f, g, h)


class Companions(NamedTuple):
    """C further states that live on the covariance and gains of the first: they differ only in the jerk they expect and
    in the part of a correction that they take. Level 0 below is the filter's own state.

    Which level is believed is decided by evidence, gathered in G groups of sensors.
    """

    x: Array  # (C, 3, n)
    jerk: Array  # (C, n) rad/s^3 over the interval that follows
    part: Array  # (C, 3, n) of the correction that is taken, 1 for all of it
    group: Indices  # (n,) whose evidence decides over a joint, -1: the filter's own state stands
    member: Array  # (G, S) 1 where a sensor belongs to a group
    evidence: Array  # (C, G, 2) mean and power of the difference in squared innovation to the level below
    weight: Array  # (C, G) 0 to 1, against the level below
    estimate: Array  # (3, n) the blend of all levels
    gate: Array  # (3,) memory s, doubt, refusal
    innovation: Array  # (C, S, 6) scratch
    heading: Array  # (C, 3) scratch: rad of pelvis, right and left thigh
    virtual_innovation: Array  # (C, 6) scratch
    dx: Array  # (C, M) scratch
    squared: Array  # (C + 1, S) scratch: squared innovations of the gyroscopes in units of their standard deviation
    y: Array  # (6,) scratch


class Update(NamedTuple):
    """Scratch: rows and gains of the measurement update."""

    H: Array  # (S, 6, M)
    innovation: Array  # (S, 6)
    virtual_H: Array  # (6, M)
    virtual_innovation: Array  # (6,)
    virtual_variance: Array  # (6,)
    dx: Array  # (M,)
    W: Array  # (6, M)
    L: Array  # (6, 6), after the whitening its Cholesky factor, the diagonal as the reciprocal
    y: Array  # (6,)
    width: Width  # M
