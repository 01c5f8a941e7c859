"""The heading between both sensors: first from the shared joint, then held by the hinge.

The axis of a hinge is one line: turning the shank's world about the vertical until both axes point alike gives the
heading (Laidig et al. 2017). It says the more, the more horizontal the axis is, so the filter's measurement noise
grows with 1 / |horizontal part|^2; with an upright axis the heading coasts.
"""

from math import atan2, sqrt

from services.biomech.two_sensor_knee.compiled import compiled
from services.biomech.two_sensor_knee.joint_centre import is_joint_trusted
from services.biomech.two_sensor_knee.memory import SHANK, THIGH, Bench, Memory
from services.biomech.two_sensor_knee.turns import wrapped

JOINT_HEADING_STD = 0.35
"""rad. Of a heading told by the shared joint; measured on people."""


@compiled
def tie(memory: Memory, bench: Bench, axis_std: float, dt_s: float) -> None:
    """One scalar Kalman step of the heading, with the angle between the horizontal parts of both axes."""
    knee, parameters, R, axes = memory.knee[0], bench.parameters[0], bench.R, memory.axes
    drift = parameters.heading_drift**2
    knee.heading_variance += drift * dt_s
    if axis_std > parameters.axis_to_tie:
        return
    z1 = R[0, 2, 0] * axes[THIGH, 0] + R[0, 2, 1] * axes[THIGH, 1] + R[0, 2, 2] * axes[THIGH, 2]
    x1 = R[0, 0, 0] * axes[THIGH, 0] + R[0, 0, 1] * axes[THIGH, 1] + R[0, 0, 2] * axes[THIGH, 2]
    z2 = R[1, 2, 0] * axes[SHANK, 0] + R[1, 2, 1] * axes[SHANK, 1] + R[1, 2, 2] * axes[SHANK, 2]
    x2 = R[1, 0, 0] * axes[SHANK, 0] + R[1, 0, 1] * axes[SHANK, 1] + R[1, 0, 2] * axes[SHANK, 2]
    # h1 conj(h2) with h = z + i x
    real, imaginary = z1 * z2 + x1 * x2, x1 * z2 - z1 * x2
    weight = sqrt(real * real + imaginary * imaginary)
    if weight < 1e-4:
        return
    # In the steady state the gain is dt / heading_time, because P = drift * heading_time.
    density = (drift * parameters.heading_time_s**2 + axis_std**2 * parameters.axis_correlation_s) / weight
    gain = knee.heading_variance / (knee.heading_variance + density / dt_s)
    knee.heading = wrapped(knee.heading + gain * wrapped(atan2(imaginary, real) - knee.heading))
    knee.heading_variance *= 1.0 - gain


@compiled
def take_joint_heading(memory: Memory, bench: Bench) -> None:
    """Begin with the joint's heading; begin anew when it contradicts the tie several times in a row."""
    knee, parameters = memory.knee[0], bench.parameters[0]
    if not is_joint_trusted(knee, parameters):
        return
    if knee.is_tied > 0.0:
        contradicts = abs(wrapped(knee.joint_heading - knee.heading)) > parameters.heading_error
        knee.contradictions = knee.contradictions + 1.0 if contradicts else 0.0
        if knee.contradictions < parameters.heading_contradictions:
            return
    begin_hinge(memory)


@compiled
def begin_hinge(memory: Memory) -> None:
    """Take the joint's heading; forget axis, angle and posture."""
    knee = memory.knee[0]
    knee.heading, knee.heading_variance = knee.joint_heading, JOINT_HEADING_STD**2
    knee.is_tied, knee.contradictions, knee.moving_s = 1.0, 0.0, 0.0
    knee.angle, knee.zero, knee.is_zero_set, knee.is_sign_known = 0.0, 0.0, 0.0, 0.0
    memory.scatter[:] = 0.0
    memory.axes[:] = 0.0
    posture = memory.posture[0]
    posture.weight = posture.angle = posture.height = 0.0
    posture.angle_height = posture.angle2 = posture.height2 = 0.0
