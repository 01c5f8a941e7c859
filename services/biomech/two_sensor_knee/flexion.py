"""The angle about the axis, its zero and its uncertainty."""

from math import atan2, sin, sqrt

from services.biomech.two_sensor_knee.compiled import compiled
from services.biomech.two_sensor_knee.memory import SHANK, THIGH, Bench, FloatArray, Memory, Record
from services.biomech.two_sensor_knee.turns import wrapped


@compiled
def twist(relative: FloatArray, axes: FloatArray, across: FloatArray) -> float:
    """Angle about the axis, rad, of R_thigh_from_shank between both `across` directions.

    The twist of the swing-twist decomposition: unlike the first Euler angle it changes by a constant only when
    either sensor is mounted otherwise. With x = across, y = axis x across of both segments:
    atan2(y1'Rx2 - x1'Ry2, x1'Rx2 + y1'Ry2).
    """
    a1, a2, x1, x2 = axes[THIGH], axes[SHANK], across[THIGH], across[SHANK]
    y1 = (a1[1] * x1[2] - a1[2] * x1[1], a1[2] * x1[0] - a1[0] * x1[2], a1[0] * x1[1] - a1[1] * x1[0])
    y2 = (a2[1] * x2[2] - a2[2] * x2[1], a2[2] * x2[0] - a2[0] * x2[2], a2[0] * x2[1] - a2[1] * x2[0])
    sine, cosine = 0.0, 0.0
    for i in range(3):
        x2_i = relative[i, 0] * x2[0] + relative[i, 1] * x2[1] + relative[i, 2] * x2[2]
        y2_i = relative[i, 0] * y2[0] + relative[i, 1] * y2[1] + relative[i, 2] * y2[2]
        sine += y1[i] * x2_i - x1[i] * y2_i
        cosine += x1[i] * x2_i + y1[i] * y2_i
    return atan2(sine, cosine)


@compiled
def follow_angle(memory: Memory, bench: Bench) -> None:
    """Unwrap the angle."""
    knee = memory.knee
    knee.angle += wrapped(twist(bench.relative, memory.axes, memory.across) - knee.angle)


@compiled
def settle_zero(memory: Memory, parameters: Record) -> None:
    """Zero = the angle of the tallest rest, if that was standing: upright, and the knee moves to one side of it only.

    Sitting on a bicycle is upright enough, but there the knee moves to both sides.
    """
    knee, posture = memory.knee, memory.posture
    if not is_upright(memory, parameters):
        return
    angle = posture.angle / posture.weight
    variance = max(posture.angle2 / posture.weight - angle * angle, 0.0)
    zero = angle_of_verticals(memory.standing, memory.axes, memory.across)
    # The same turn of the circle as the angle: a knee bends by less than half a turn either way.
    zero = angle + wrapped(zero - angle)
    is_one_sided = (angle - zero) ** 2 > parameters.one_sided**2 * variance
    knee.is_standing = 1.0 if is_one_sided else 0.0
    knee.standing_angle = zero
    if knee.is_zero_set == 0.0:
        knee.zero = zero if is_one_sided else 0.0


@compiled
def take_standing(memory: Memory, bench: Bench) -> None:
    """Remember both verticals of the tallest rest so far; it may come before anything is known of the knee.

    Sitting still comes before standing still, so a later rest that is taller takes the place of the one before.
    """
    knee, parameters, levels = memory.knee, bench.parameters, memory.levels
    if levels[THIGH].rest_s < parameters.calm_s or levels[SHANK].rest_s < parameters.calm_s:
        return
    up_thigh, up_shank = bench.R[THIGH, 1], bench.R[SHANK, 1]
    height = sensor_height(memory, up_thigh, up_shank)
    known = sensor_height(memory, memory.standing[THIGH], memory.standing[SHANK])
    if knee.has_standing == 0.0 or height > known + parameters.taller:
        knee.has_standing = 1.0
        for i in range(3):
            memory.standing[THIGH, i], memory.standing[SHANK, i] = up_thigh[i], up_shank[i]


@compiled
def is_upright(memory: Memory, parameters: Record) -> bool:
    """Whether at the tallest rest the knee was below the thigh's sensor and above the shank's."""
    if memory.knee.has_standing == 0.0:
        return False
    thigh = upright_share(memory, THIGH, memory.standing[THIGH])
    shank = upright_share(memory, SHANK, memory.standing[SHANK])
    if arm_length(memory, SHANK) < parameters.shortest_arm:
        shank = 1.0
    is_known = arm_length(memory, THIGH) >= parameters.shortest_arm
    return bool(is_known and min(thigh, shank) >= parameters.upright_share)


@compiled
def arm_length(memory: Memory, segment: int) -> float:
    """Distance from a sensor to the knee, m."""
    x, y, z = memory.arms[segment, 0], memory.arms[segment, 1], memory.arms[segment, 2]
    return sqrt(x * x + y * y + z * z)


@compiled
def upright_share(memory: Memory, segment: int, up: FloatArray) -> float:
    """Vertical share of a segment's direction: down the thigh from its sensor to the knee, on to the shank's."""
    down = 0.0
    for i in range(3):
        down -= up[i] * memory.arms[segment, i]
    length = arm_length(memory, segment) + 1e-9
    return down / length if segment == THIGH else -down / length


@compiled
def angle_of_verticals(up: FloatArray, axes: FloatArray, across: FloatArray) -> float:
    """Angle about the axis, rad, at which the verticals up (2, 3) of both sensors are one: no heading is needed."""
    real, imaginary = 1.0, 0.0
    for s in range(2):
        a, x = axes[s], across[s]
        y = (a[1] * x[2] - a[2] * x[1], a[2] * x[0] - a[0] * x[2], a[0] * x[1] - a[1] * x[0])
        along_x = x[0] * up[s, 0] + x[1] * up[s, 1] + x[2] * up[s, 2]
        along_y = y[0] * up[s, 0] + y[1] * up[s, 1] + y[2] * up[s, 2]
        sign = 1.0 if s == THIGH else -1.0
        real, imaginary = real * along_x - sign * imaginary * along_y, imaginary * along_x + sign * real * along_y
    return atan2(imaginary, real)


@compiled
def sensor_height(memory: Memory, up_thigh: FloatArray, up_shank: FloatArray) -> float:
    """Height of the thigh's sensor over the shank's, m: up the shank's arm to the knee, and back down the thigh's."""
    height = 0.0
    for i in range(3):
        height += up_shank[i] * memory.arms[SHANK, i] - up_thigh[i] * memory.arms[THIGH, i]
    return height


@compiled
def angle_deviation(memory: Memory, bench: Bench, axis_std: float) -> float:
    """Standard deviation of the flexion, rad: inclination of both sensors, axis, and heading at an upright axis."""
    knee, parameters, R, axes = memory.knee, bench.parameters, bench.R, memory.axes
    variance = 0.0
    for s in range(2):
        variance += parameters.level_std**2
        variance += parameters.level_start_std**2 / max(memory.levels[s].elapsed_s, 0.1)
    upright = R[THIGH, 1, 0] * axes[THIGH, 0] + R[THIGH, 1, 1] * axes[THIGH, 1] + R[THIGH, 1, 2] * axes[THIGH, 2]
    variance += knee.heading_variance * upright**2
    return sqrt(variance + (axis_std * sin(knee.angle - knee.zero)) ** 2)


@compiled
def turn_from_sensor_axes(axes: FloatArray, across: FloatArray) -> float:
    """Angle, rad, to be added for the datum of McGrath et al., eq. 2: z = axis, y = axis x (1, 0, 0) in both segments.

    Angle of `across` in the thigh's frame minus that in the shank's. Not a number where an axis is its sensor's x.
    """
    # With y = (0, a_z, -a_y) and x = y x a, both scaled by the same 1 / |y|, which the angle does not see.
    real, imaginary = 1.0, 0.0
    for s in range(2):
        ax, ay, az = axes[s, 0], axes[s, 1], axes[s, 2]
        along_y = az * across[s, 1] - ay * across[s, 2]
        along_x = (az * az + ay * ay) * across[s, 0] - ax * (ay * across[s, 1] + az * across[s, 2])
        sign = 1.0 if s == 0 else -1.0
        real, imaginary = real * along_x - sign * imaginary * along_y, imaginary * along_x + sign * real * along_y
    return atan2(imaginary, real)
