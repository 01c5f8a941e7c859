"""The heading between both sensors: first from the shared joint, then held by the hinge.

The axis of a hinge is one line: turning the shank's world about the vertical until both axes point alike gives the
heading (Laidig et al. 2017). It says the more, the more horizontal the axis is, so the filter's measurement noise
grows with 1 / |horizontal part|^2; with an upright axis the heading coasts.
"""

from math import atan2, pi, sqrt

from services.biomech.two_sensor_knee.compiled import compiled
from services.biomech.two_sensor_knee.joint_centre import is_joint_trusted
from services.biomech.two_sensor_knee.memory import SHANK, THIGH, Bench, Memory
from services.biomech.two_sensor_knee.turns import fill_relative, wrapped

JOINT_HEADING_STD = 0.35
"""rad. Of a heading told by the shared joint; measured on people."""
RATES_HEADING_STD = 0.7
"""rad. Of a heading told by the directions of both rates."""


@compiled
def tie(memory: Memory, bench: Bench, axis_std: float, dt_s: float) -> None:
    """One scalar Kalman step of the heading, with the angle between the horizontal parts of both axes."""
    knee, parameters, R, axes = memory.knee, bench.parameters, bench.R, memory.axes
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
    knee, parameters = memory.knee, bench.parameters
    if not is_joint_trusted(knee, parameters):
        return
    if knee.is_tied > 0.0:
        contradicts = abs(wrapped(knee.joint_heading - knee.heading)) > parameters.heading_error
        knee.contradictions = (knee.contradictions + 1.0) * contradicts
        if knee.contradictions < parameters.heading_contradictions:
            knee.is_half_turn_open *= contradicts
            return
    begin_hinge(memory, bench, knee.joint_heading, JOINT_HEADING_STD)
    knee.is_half_turn_open = 0.0


@compiled
def tie_without_joint(memory: Memory, bench: Bench, dt_s: float) -> None:
    """Where the knee rests while the leg moves (a swinging shank, a rising thigh) nothing tells the heading but that
    both segments turn about one horizontal line: half the angle of the mean of (h1 conj h2)^2 / |h1 conj h2|.

    Half a turn stays open: the joint chooses, as far as it says anything yet. While one segment is still any heading
    gives the same flexion up to its sign; when both move the joint will contradict a wrong one.
    """
    knee, parameters, R, rate = memory.knee, bench.parameters, bench.R, bench.rate
    z1 = R[0, 2, 0] * rate[0, 0] + R[0, 2, 1] * rate[0, 1] + R[0, 2, 2] * rate[0, 2]
    x1 = R[0, 0, 0] * rate[0, 0] + R[0, 0, 1] * rate[0, 1] + R[0, 0, 2] * rate[0, 2]
    z2 = R[1, 2, 0] * rate[1, 0] + R[1, 2, 1] * rate[1, 1] + R[1, 2, 2] * rate[1, 2]
    x2 = R[1, 0, 0] * rate[1, 0] + R[1, 0, 1] * rate[1, 1] + R[1, 0, 2] * rate[1, 2]
    real, imaginary = z1 * z2 + x1 * x2, x1 * z2 - z1 * x2
    length = sqrt(real * real + imaginary * imaginary)
    if length > 0.0:
        knee.rates_real += dt_s * (real * real - imaginary * imaginary) / length
        knee.rates_imaginary += dt_s * 2.0 * real * imaginary / length
    if max(z1 * z1 + x1 * x1, z2 * z2 + x2 * x2) > parameters.moving_rate**2:
        knee.untied_moving_s += dt_s
    if knee.untied_moving_s >= parameters.untied_s:
        heading = 0.5 * atan2(knee.rates_imaginary, knee.rates_real)
        is_told = knee.joint_coherence >= parameters.joint_coherence
        if is_told and abs(wrapped(heading - knee.joint_heading)) > 0.5 * pi:
            heading = wrapped(heading + pi)
        begin_hinge(memory, bench, heading, RATES_HEADING_STD)
        knee.is_half_turn_open = 1.0


@compiled
def begin_hinge(memory: Memory, bench: Bench, heading: float, std: float) -> None:
    """Begin with this heading (rad, and its deviation); forget axis, angle and posture."""
    knee = memory.knee
    knee.heading, knee.heading_variance = heading, std**2
    knee.is_tied, knee.contradictions, knee.moving_s, knee.axis_std, knee.has_angle = 1.0, 0.0, 0.0, 0.0, 0.0
    knee.angle, knee.zero, knee.is_zero_set, knee.is_sign_known, knee.is_standing = 0.0, 0.0, 0.0, 0.0, 0.0
    for s in range(2):
        for i in range(3):
            memory.axes[s, i] = 0.0
            for k in range(3):
                memory.scatter[s, i, k] = 0.0
    posture = memory.posture
    posture.weight = posture.angle = posture.height = posture.upright = 0.0
    posture.angle_height = posture.angle2 = posture.angle3 = posture.height2 = 0.0
    fill_relative(bench.R[THIGH], bench.R[SHANK], heading, memory.relative)
