"""Predicted samples and their Jacobian rows. World y is up, so gravity appears as +9.81 along y at rest."""

import math

from services.biomech.kernels.compiled import inlined, kernel
from services.biomech.kernels.tables import Array, Body, Motion, Options, Sensors
from services.biomech.kernels.vectors import (
    Vector,
    add,
    cross,
    load,
    rotate,
    rotate_back,
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


@kernel
def place_sensor(s: int, sensors: Sensors, motion: Motion) -> None:
    """R_world_from_sensor = R_world_from_segment R_segment_from_sensor."""
    b = sensors.joint[s]
    for i in range(3):
        for k in range(3):
            motion.sensor[i, k] = (
                motion.rotation[b, i, 0] * sensors.rotation[s, 0, k]
                + motion.rotation[b, i, 1] * sensors.rotation[s, 1, k]
                + motion.rotation[b, i, 2] * sensors.rotation[s, 2, k]
            )


@kernel
def gyro_rows(s: int, body: Body, sensors: Sensors, options: Options, motion: Motion, z: Array, H: Array) -> None:
    """z[0:3] = R' w;  d/d(dq_j) = R' a_j;  d/dq_j = R' da_j/dt where the options ask for it."""
    n, t = body.parent.size, body.translations
    w = rotate_back(motion.sensor, load(motion.rate, sensors.joint[s]))
    z[0], z[1], z[2] = w
    for i in range(sensors.path_length[s]):
        j = sensors.path[s, i]
        if j < t:
            continue
        put(H, 0, column(1, j, t, n), rotate_back(motion.sensor, load(motion.axis, j)))
        if options.gyro_sees_position:
            put(H, 0, column(0, j, t, n), rotate_back(motion.sensor, load(motion.axis_rate, j)))


@kernel
def gravity_rows(s: int, body: Body, sensors: Sensors, motion: Motion, z: Array, H: Array) -> None:
    """The accelerometer as a gravity sensor: z[3:6] = R' (0, g, 0);  d/dq_j = -R' (a_j x g)."""
    n, t = body.parent.size, body.translations
    up = (0.0, GRAVITY, 0.0)
    f = rotate_back(motion.sensor, up)
    z[3], z[4], z[5] = f
    for i in range(sensors.path_length[s]):
        j = sensors.path[s, i]
        if j >= t:
            put(H, 3, column(0, j, t, n), rotate_back(motion.sensor, cross(up, load(motion.axis, j))))


@kernel
def dynamic_rows(s: int, body: Body, sensors: Sensors, motion: Motion, z: Array, H: Array) -> None:
    """The accelerometer with the whole motion: z[3:6] = R' f with f = A + (0, g, 0) at the sensor.

    With r, r', r'' from the joint's origin to the sensor and their derivatives:
    d/d(ddq) = R'(a x r);  d/d(dq) = 2 R'(a' x r + a x r');  d/dq = R'(a'' x r + 2 a' x r' + a x (r'' - f)).
    """
    n, t = body.parent.size, body.translations
    b = sensors.joint[s]
    arm, w = rotate(motion.rotation, b, load(sensors.position, s)), load(motion.rate, b)
    swing = cross(w, arm)
    P, V = add(load(motion.origin, b), arm), add(load(motion.origin_velocity, b), swing)
    turning = add(cross(load(motion.angular_acceleration, b), arm), cross(w, swing))
    A = add(load(motion.origin_acceleration, b), turning)
    f = (A[0], A[1] + GRAVITY, A[2])
    z[3], z[4], z[5] = rotate_back(motion.sensor, f)
    for i in range(sensors.path_length[s]):
        j = sensors.path[s, i]
        a = load(motion.axis, j)
        if j < t:
            put(H, 3, column(2, j, t, n), rotate_back(motion.sensor, a))
            continue
        a_rate = load(motion.axis_rate, j)
        r, r_rate = subtract(P, load(motion.origin, j)), subtract(V, load(motion.origin_velocity, j))
        r_acc = subtract(A, load(motion.origin_acceleration, j))
        by_velocity = scale(2.0, add(cross(a_rate, r), cross(a, r_rate)))
        by_position = add(cross(load(motion.axis_acceleration, j), r), scale(2.0, cross(a_rate, r_rate)))
        by_position = add(by_position, cross(a, subtract(r_acc, f)))
        put(H, 3, column(2, j, t, n), rotate_back(motion.sensor, cross(a, r)))
        put(H, 3, column(1, j, t, n), rotate_back(motion.sensor, by_velocity))
        put(H, 3, column(0, j, t, n), rotate_back(motion.sensor, by_position))


@kernel
def yaw_row(b: int, body: Body, motion: Motion, sign: float, row: Array) -> float:
    """Heading of the segment behind joint b, and sign times its derivative added to the row.

    yaw = atan2(-c_z, c_x) of the forward axis c = R e_x, positive when turned to the left (about +y).
    dc/dq_j = a_j x c, so d(yaw)/dq_j = (c_z d_x - c_x d_z) / (c_x^2 + c_z^2) with d = a_j x c.
    """
    n, t = body.parent.size, body.translations
    c = (motion.rotation[b, 0, 0], motion.rotation[b, 1, 0], motion.rotation[b, 2, 0])
    flat = c[0] * c[0] + c[2] * c[2] + 1e-12
    j = b
    while j >= t:
        d = cross(load(motion.axis, j), c)
        row[column(0, j, t, n)] += sign * (c[2] * d[0] - c[0] * d[2]) / flat
        j = body.parent[j]
    return math.atan2(-c[2], c[0])
