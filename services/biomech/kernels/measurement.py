"""Predicted samples and their Jacobian rows. World y is up, so gravity appears as +9.81 along y at rest."""

import math

from services.biomech.kernels.compiled import inlined, kernel
from services.biomech.kernels.tables import Array, Body, Motion, Options, Sensors
from services.biomech.kernels.vectors import (
    Axes,
    Vector,
    add,
    cross,
    into,
    load,
    rotate,
    scale,
    subtract,
)

GRAVITY = 9.81


@inlined
def column(order: int, j: int, translations: int, joints: int) -> int:
    """Covariance column of joint j's position (0), velocity (1) or acceleration (2)."""
    rotations = joints - translations
    return order * rotations + j - translations if j >= translations else 3 * rotations + j


@inlined
def put(H: Array, row: int, col: int, v: Vector) -> None:
    """Three rows of one column."""
    H[row, col] = v[0]
    H[row + 1, col] = v[1]
    H[row + 2, col] = v[2]


@inlined
def sensor_axes(s: int, sensors: Sensors, motion: Motion) -> Axes:
    """Columns of R_world_from_sensor = R_world_from_segment R_segment_from_sensor."""
    b, R = sensors.joint[s], sensors.rotation
    x = rotate(motion.rotation, b, (R[s, 0, 0], R[s, 1, 0], R[s, 2, 0]))
    y = rotate(motion.rotation, b, (R[s, 0, 1], R[s, 1, 1], R[s, 2, 1]))
    z = rotate(motion.rotation, b, (R[s, 0, 2], R[s, 1, 2], R[s, 2, 2]))
    return x, y, z


@kernel
def gyro_rows(s: int, body: Body, sensors: Sensors, options: Options, motion: Motion, z: Array, H: Array) -> None:
    """z[0:3] = R' w;  d/d(dq_j) = R' a_j;  d/dq_j = R' da_j/dt where the options ask for it."""
    n, t = body.parent.size, body.translations
    axes = sensor_axes(s, sensors, motion)
    z[0], z[1], z[2] = into(axes, load(motion.rate, sensors.joint[s]))
    for i in range(sensors.path_length[s]):
        j = sensors.path[s, i]
        if j < t:
            continue
        put(H, 0, column(1, j, t, n), into(axes, load(motion.axis, j)))
        if options.gyro_sees_position:
            put(H, 0, column(0, j, t, n), into(axes, load(motion.axis_rate, j)))


@kernel
def gravity_rows(s: int, body: Body, sensors: Sensors, motion: Motion, z: Array, H: Array) -> None:
    """The accelerometer as a gravity sensor: z[3:6] = f = R' (0, g, 0);  d/dq_j = f x R' a_j.

    Needs `gyro_rows` before: R' a_j stands in its velocity columns.
    """
    n, t = body.parent.size, body.translations
    f = into(sensor_axes(s, sensors, motion), (0.0, GRAVITY, 0.0))
    z[3], z[4], z[5] = f
    for i in range(sensors.path_length[s]):
        j = sensors.path[s, i]
        if j >= t:
            c = column(1, j, t, n)
            put(H, 3, column(0, j, t, n), cross(f, (H[0, c], H[1, c], H[2, c])))


@inlined
def motion_at(s: int, sensors: Sensors, motion: Motion) -> tuple[Vector, Vector, Vector]:
    """Where a sensor is in the world, its velocity and acceleration.

    P = o + r,  V = o' + w x r,  A = o'' + al x r + w x (w x r).
    """
    b = sensors.joint[s]
    arm, w = rotate(motion.rotation, b, load(sensors.position, s)), load(motion.rate, b)
    swing = cross(w, arm)
    turning = add(cross(load(motion.angular_acceleration, b), arm), cross(w, swing))
    return (
        add(load(motion.origin, b), arm),
        add(load(motion.origin_velocity, b), swing),
        add(load(motion.origin_acceleration, b), turning),
    )


@kernel
def expected_sample(s: int, sensors: Sensors, options: Options, motion: Motion, z: Array) -> None:
    """z (6,) alone: angular velocity and specific force, without rows."""
    axes = sensor_axes(s, sensors, motion)
    z[0], z[1], z[2] = into(axes, load(motion.rate, sensors.joint[s]))
    f = (0.0, GRAVITY, 0.0)
    if options.accel_sees_motion:
        _, _, A = motion_at(s, sensors, motion)
        f = (A[0], A[1] + GRAVITY, A[2])
    z[3], z[4], z[5] = into(axes, f)


@kernel
def subtract_from(s: int, samples: Array, bias: Array, force_bound: float, z: Array) -> None:
    """z (6,) becomes the sample of sensor s without its bias, minus z. A force longer than the bound is shortened."""
    length = math.sqrt(samples[s, 3] ** 2 + samples[s, 4] ** 2 + samples[s, 5] ** 2)
    share = 1.0 if length <= force_bound else force_bound / length
    for i in range(3):
        z[i] = samples[s, i] - bias[s, i] - z[i]
        z[i + 3] = share * samples[s, i + 3] - z[i + 3]


@kernel
def dynamic_rows(s: int, body: Body, sensors: Sensors, motion: Motion, z: Array, H: Array) -> None:
    """The accelerometer with the whole motion: z[3:6] = R' f with f = A + (0, g, 0) at the sensor.

    With r, r', r'' from the joint's origin to the sensor and their derivatives:
    d/d(ddq) = R'(a x r);  d/d(dq) = 2 R'(a' x r + a x r');  d/dq = R'(a'' x r + 2 a' x r' + a x (r'' - f)).
    """
    n, t = body.parent.size, body.translations
    axes = sensor_axes(s, sensors, motion)
    P, V, A = motion_at(s, sensors, motion)
    f = (A[0], A[1] + GRAVITY, A[2])
    z[3], z[4], z[5] = into(axes, f)
    for i in range(sensors.path_length[s]):
        j = sensors.path[s, i]
        a = load(motion.axis, j)
        if j < t:
            put(H, 3, column(2, j, t, n), into(axes, a))
            continue
        a_rate = load(motion.axis_rate, j)
        r, r_rate = subtract(P, load(motion.origin, j)), subtract(V, load(motion.origin_velocity, j))
        r_acc = subtract(A, load(motion.origin_acceleration, j))
        by_velocity = scale(2.0, add(cross(a_rate, r), cross(a, r_rate)))
        by_position = add(cross(load(motion.axis_acceleration, j), r), scale(2.0, cross(a_rate, r_rate)))
        by_position = add(by_position, cross(a, subtract(r_acc, f)))
        put(H, 3, column(2, j, t, n), into(axes, cross(a, r)))
        put(H, 3, column(1, j, t, n), into(axes, by_velocity))
        put(H, 3, column(0, j, t, n), into(axes, by_position))


@inlined
def forward_axis(b: int, motion: Motion) -> Vector:
    """x axis in the world of the segment behind joint b."""
    return motion.rotation[b, 0, 0], motion.rotation[b, 1, 0], motion.rotation[b, 2, 0]


@inlined
def yaw_of(c: Vector) -> float:
    """Heading of a forward axis, rad."""
    return math.atan2(-c[2], c[0])


@kernel
def yaw_row(b: int, body: Body, motion: Motion, sign: float, row: Array) -> float:
    """Heading of the segment behind joint b, and sign times its derivative added to the row.

    yaw = atan2(-c_z, c_x) of the forward axis c = R e_x, positive when turned to the left (about +y).
    dc/dq_j = a_j x c, so d(yaw)/dq_j = (c_z d_x - c_x d_z) / (c_x^2 + c_z^2) with d = a_j x c.
    """
    n, t = body.parent.size, body.translations
    c = forward_axis(b, motion)
    flat = c[0] * c[0] + c[2] * c[2] + 1e-12
    j = b
    while j >= t:
        d = cross(load(motion.axis, j), c)
        row[column(0, j, t, n)] += sign * (c[2] * d[0] - c[0] * d[2]) / flat
        j = body.parent[j]
    return yaw_of(c)
