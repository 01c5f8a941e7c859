"""Orientation of one sensor from its gyroscope and accelerometer; the heading is arbitrary and drifts.

The idea of Laidig and Seel (VQF, Information Fusion 2023): low-pass the specific force where it is nearly constant, in
the world that the gyroscope keeps, so that impacts and swings average out, and turn that world so that the mean
points up. The turn this needs in the long run is the gyroscope's bias. Beside it the force of the instant turns the
world a little: a sensor on soft tissue swings farther than its bone, and its accelerometer, like a pendulum's, reads
less.
"""

from math import atan2, sqrt

from services.biomech.two_sensor_knee.compiled import compiled
from services.biomech.two_sensor_knee.memory import FloatArray, Record
from services.biomech.two_sensor_knee.turns import fill_matrix, low_pass_gain, product, turn_by, turned, unit


@compiled
def follow_level(
    level: Record, rate: FloatArray, force: FloatArray, dt_s: float, parameters: Record, R: FloatArray, is_new: bool
) -> None:
    """Take one sample: rate (3,) rad/s measured, force (3,) m/s^2, dt_s after the one before; R (3, 3) is written.

    A sample that is not new, because it is taken a second time, says nothing about the bias.
    """
    level.elapsed_s += dt_s
    is_at_rest = follow_rest(level, rate, force, dt_s, parameters)
    quat = (level.quat[0], level.quat[1], level.quat[2], level.quat[3])
    x, y, z = rate[0] - level.bias[0], rate[1] - level.bias[1], rate[2] - level.bias[2]
    quat = product(quat, turn_by(x * dt_s, y * dt_s, z * dt_s))
    low_pass_force(level, turned(quat, force[0], force[1], force[2]), dt_s, parameters)
    turn_x, turn_z = level_by(level)
    quat = product(turn_by(turn_x, 0.0, turn_z), quat)
    tilt_x, tilt_z = tilt_by(turned(quat, force[0], force[1], force[2]), parameters.tilt_rate * dt_s)
    quat = unit(product(turn_by(tilt_x, 0.0, tilt_z), quat))
    for i in range(4):
        level.quat[i] = quat[i]
    fill_matrix(quat, R)
    if is_new:
        low_pass_tilt(level, tilt_x / dt_s, tilt_z / dt_s, dt_s, parameters)
        rate_x, rate_z = turn_x / dt_s + level.tilted[0], turn_z / dt_s + level.tilted[1]
        follow_bias(level, R, rate_x, rate_z, is_at_rest, dt_s, parameters)


@compiled
def low_pass_tilt(level: Record, rate_x: float, rate_z: float, dt_s: float, parameters: Record) -> None:
    """The rate (x, z), rad/s, at which the force of the instant turns the world, as late as that of the mean."""
    gain = low_pass_gain(parameters.level_time_s, dt_s)
    level.tilted_fast[0] += gain * (rate_x - level.tilted_fast[0])
    level.tilted_fast[1] += gain * (rate_z - level.tilted_fast[1])
    for k in range(2):
        level.tilted[k] += gain * (level.tilted_fast[k] - level.tilted[k])


@compiled
def low_pass_force(level: Record, force: tuple[float, float, float], dt_s: float, parameters: Record) -> None:
    """Two equal low-passes; the plain mean while younger than their time."""
    young = level.elapsed_s < parameters.level_time_s
    gain = dt_s / level.elapsed_s if young else low_pass_gain(parameters.level_time_s, dt_s)
    for i in range(3):
        level.force_fast[i] += gain * (force[i] - level.force_fast[i])
        if young:
            level.force[i] = level.force_fast[i]
        else:
            level.force[i] += gain * (level.force_fast[i] - level.force[i])


@compiled
def tilt_by(felt: tuple[float, float, float], share: float) -> tuple[float, float]:
    """This share of the turn (x, z), rad, that brings the force felt now, in the world, upright."""
    size = sqrt(felt[0] * felt[0] + felt[1] * felt[1] + felt[2] * felt[2]) + 1e-9
    return -share * felt[2] / size, share * felt[0] / size


@compiled
def level_by(level: Record) -> tuple[float, float]:
    """Horizontal rotation vector (x, z), rad, that brings the mean force upright; the kept means are turned along."""
    fx, fy, fz = level.force[0], level.force[1], level.force[2]
    square = fx * fx + fz * fz
    # f x up = (-fz, 0, fx): the right-hand turn from f to up. Below 0.01 rad, tangent for angle is good to 3e-5.
    if square < 1e-4 * fy * abs(fy):
        scale = 1.0 / fy
    else:
        across = sqrt(square)
        if across < 1e-9 * abs(fy):
            # Exactly upside down: any half turn about a horizontal axis will do.
            fx, across = 1e-9 * abs(fy), 1e-9 * abs(fy)
        scale = atan2(across, fy) / (across + 1e-12)
    turn_x, turn_z = -fz * scale, fx * scale
    correction = turn_by(turn_x, 0.0, turn_z)
    fast = turned(correction, level.force_fast[0], level.force_fast[1], level.force_fast[2])
    mean = turned(correction, fx, fy, fz)
    for i in range(3):
        level.force_fast[i] = fast[i]
        level.force[i] = mean[i]
    return turn_x, turn_z


@compiled
def follow_rest(level: Record, rate: FloatArray, force: FloatArray, dt_s: float, parameters: Record) -> bool:
    """Whether rate and force have stayed near their own slow means for `calm_s`."""
    gain = low_pass_gain(parameters.calm_time_s, dt_s)
    if level.elapsed_s <= dt_s:
        gain = 1.0
    rate_off, force_off, slow = 0.0, 0.0, 0.0
    for i in range(3):
        level.calm_rate[i] += gain * (rate[i] - level.calm_rate[i])
        level.calm_force[i] += gain * (force[i] - level.calm_force[i])
        rate_off += (rate[i] - level.calm_rate[i]) ** 2
        force_off += (force[i] - level.calm_force[i]) ** 2
        slow += level.calm_rate[i] ** 2
    is_calm = (
        rate_off < parameters.calm_rate**2
        and force_off < parameters.calm_force**2
        and slow < parameters.largest_bias**2
    )
    level.rest_s = level.rest_s + dt_s if is_calm else 0.0
    return bool(level.rest_s >= parameters.calm_s)


@compiled
def follow_bias(
    level: Record,
    R: FloatArray,
    turn_rate_x: float,
    turn_rate_z: float,
    is_at_rest: bool,
    dt_s: float,
    parameters: Record,
) -> None:
    """Kalman filter of the bias: measured whole at rest, by the rate of levelling otherwise.

    A wrong bias b - b^ tips the world by R (b - b^) dt a sample; levelling takes back the low-passed tip. So
    -turn / dt + LP(R b^) = LP(R) b on the two horizontal axes.
    """
    gain = low_pass_gain(parameters.level_time_s, dt_s)
    bias, covariance = level.bias, level.bias_covariance
    for k in range(2):
        row = 2 * k
        removed = R[row, 0] * bias[0] + R[row, 1] * bias[1] + R[row, 2] * bias[2]
        level.removed_fast[k] += gain * (removed - level.removed_fast[k])
        level.removed[k] += gain * (level.removed_fast[k] - level.removed[k])
        for i in range(3):
            level.rows_fast[k, i] += gain * (R[row, i] - level.rows_fast[k, i])
            level.rows[k, i] += gain * (level.rows_fast[k, i] - level.rows[k, i])
    wander = parameters.bias_wander**2 * dt_s / parameters.bias_time_s
    if covariance[0, 0] + covariance[1, 1] + covariance[2, 2] < 3.0 * parameters.start_bias_std**2:
        for i in range(3):
            covariance[i, i] += wander
    if is_at_rest:
        take_rest(level, steady_noise(parameters.bias_std_at_rest, wander), parameters.largest_bias)
    elif level.elapsed_s > 2.0 * parameters.level_time_s:
        noise = steady_noise(parameters.bias_std_in_motion, wander)
        take_levelling(level, turn_rate_x, turn_rate_z, noise, parameters.largest_bias)
    length = sqrt(bias[0] ** 2 + bias[1] ** 2 + bias[2] ** 2)
    if length > parameters.largest_bias:
        for i in range(3):
            bias[i] *= parameters.largest_bias / length


@compiled
def take_rest(level: Record, noise: float, limit: float) -> None:
    """Measure the whole bias, with an error of at most `limit` (rad/s); lengths are limited, so no axis is special."""
    ex, ey, ez = (
        level.calm_rate[0] - level.bias[0],
        level.calm_rate[1] - level.bias[1],
        level.calm_rate[2] - level.bias[2],
    )
    scale = min(1.0, limit / (sqrt(ex * ex + ey * ey + ez * ez) + 1e-12))
    for i in range(3):
        row = (1.0 * (i == 0), 1.0 * (i == 1), 1.0 * (i == 2))
        target = level.calm_rate[i] - (ex, ey, ez)[i] * (1.0 - scale)
        correct_bias(level, row[0], row[1], row[2], target - level.bias[i], noise)


@compiled
def take_levelling(level: Record, turn_rate_x: float, turn_rate_z: float, noise: float, limit: float) -> None:
    """Measure the horizontal part of the bias by the rate of levelling, with an error of at most `limit` (rad/s)."""
    rows, bias, removed = level.rows, level.bias, level.removed
    measured_x, measured_z = removed[0] - turn_rate_x, removed[1] - turn_rate_z
    error_x = measured_x - (rows[0, 0] * bias[0] + rows[0, 1] * bias[1] + rows[0, 2] * bias[2])
    error_z = measured_z - (rows[1, 0] * bias[0] + rows[1, 1] * bias[1] + rows[1, 2] * bias[2])
    scale = min(1.0, limit / (sqrt(error_x * error_x + error_z * error_z) + 1e-12))
    measured_x -= (1.0 - scale) * error_x
    measured_z -= (1.0 - scale) * error_z
    error = measured_x - (rows[0, 0] * bias[0] + rows[0, 1] * bias[1] + rows[0, 2] * bias[2])
    correct_bias(level, rows[0, 0], rows[0, 1], rows[0, 2], error, noise)
    # The second row sees what the first has corrected: with independent noise that is the joint update.
    error = measured_z - (rows[1, 0] * bias[0] + rows[1, 1] * bias[1] + rows[1, 2] * bias[2])
    correct_bias(level, rows[1, 0], rows[1, 1], rows[1, 2], error, noise)


@compiled
def steady_noise(std: float, wander: float) -> float:
    """Measurement variance with which the filter settles at `std`: P^2 / Q + P."""
    return std**4 / wander + std**2


@compiled
def correct_bias(level: Record, hx: float, hy: float, hz: float, error: float, noise: float) -> None:
    """One scalar Kalman update of the bias with the row (hx, hy, hz)."""
    P = level.bias_covariance
    px = P[0, 0] * hx + P[0, 1] * hy + P[0, 2] * hz
    py = P[1, 0] * hx + P[1, 1] * hy + P[1, 2] * hz
    pz = P[2, 0] * hx + P[2, 1] * hy + P[2, 2] * hz
    scale = 1.0 / (hx * px + hy * py + hz * pz + noise)
    level.bias[0] += scale * error * px
    level.bias[1] += scale * error * py
    level.bias[2] += scale * error * pz
    P[0, 0] -= scale * px * px
    P[1, 1] -= scale * py * py
    P[2, 2] -= scale * pz * pz
    P[0, 1] -= scale * px * py
    P[0, 2] -= scale * px * pz
    P[1, 2] -= scale * py * pz
    P[1, 0], P[2, 0], P[2, 1] = P[0, 1], P[0, 2], P[1, 2]
