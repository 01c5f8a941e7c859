"""One step of the filter: predict to the samples' time, then one block per sensor that has a sample."""

import numpy as np

from services.biomech.kernels.compiled import kernel
from services.biomech.kernels.covariance import (
    innovation_covariance,
    predict_covariance,
    predict_state,
    project,
    subtract_gain,
    update_scalar,
    whiten,
)
from services.biomech.kernels.kinematics import accelerate, orient
from services.biomech.kernels.measurement import (
    dynamic_rows,
    gravity_rows,
    gyro_rows,
    place_sensor,
    yaw_row,
)
from services.biomech.kernels.tables import Array, Body, Columns, Flags, Motion, Noise, Options, Sensors, Update


@kernel
def predicted_sample(
    s: int, body: Body, sensors: Sensors, options: Options, motion: Motion, z: Array, H: Array
) -> None:
    """z (6,) and H (6, N) of one sensor: angular velocity, then specific force. Needs the recursions before."""
    place_sensor(s, sensors, motion)
    gyro_rows(s, body, sensors, options, motion, z, H)
    if options.accel_sees_motion:
        dynamic_rows(s, body, sensors, motion, z, H)
    else:
        gravity_rows(s, body, sensors, motion, z, H)


@kernel
def update_sensor(s: int, P: Array, columns: Columns, noise: Noise, update: Update) -> None:
    """Block of six rows: three of the gyroscope, three of the accelerometer."""
    H, e = update.H[s], update.innovation[s]
    gyro, n_gyro = columns.gyro[s], columns.gyro_count[s]
    accel, n_accel = columns.accel[s], columns.accel_count[s]
    project(P, H, 0, 3, gyro, n_gyro, update.W)
    project(P, H, 3, 6, accel, n_accel, update.W)
    innovation_covariance(H, 0, 3, gyro, n_gyro, noise.gyro[s], e, update)
    innovation_covariance(H, 3, 6, accel, n_accel, noise.accel[s], e, update)
    whiten(6, update)
    subtract_gain(P, 6, update)


@kernel
def yaw_rows(body: Body, options: Options, motion: Motion, update: Update) -> int:
    """Rows of the virtual yaw measurement (Joukov eq. 22); how many there are."""
    H, e = update.yaw_H, update.yaw_innovation
    H[:, :] = 0.0
    bodies = options.yaw_bodies
    if options.yaw_mode == 1:
        for i in range(3):
            e[i] = -yaw_row(bodies[i], body, motion, 1.0, H[i])
        return 3
    for i in range(2):
        pelvis = yaw_row(bodies[0], body, motion, -1.0, H[i])
        thigh = yaw_row(bodies[i + 1], body, motion, 1.0, H[i])
        e[i] = (pelvis - thigh + np.pi) % (2.0 * np.pi) - np.pi
    return 2


@kernel
def update_yaw(P: Array, body: Body, options: Options, motion: Motion, noise: Noise, update: Update) -> None:
    """Measure yaw as zero, so that slow gyro drift about the vertical does not turn the legs."""
    rows = yaw_rows(body, options, motion, update)
    t = body.translations
    # Position columns of pelvis and hips lie side by side at the front of the covariance.
    for row in range(rows):
        for k in range(P.shape[0]):
            update.W[row, k] = 0.0
    last = body.parent.size - t
    for row in range(rows):
        for c in range(last):
            h = update.yaw_H[row, c]
            if h != 0.0:
                for k in range(P.shape[0]):
                    update.W[row, k] += h * P[c, k]
    for row in range(rows):
        y = update.yaw_innovation[row]
        for c in range(last):
            y -= update.yaw_H[row, c] * update.dx[c]
        update.y[row] = y
        for other in range(row + 1):
            v = 0.0
            for c in range(last):
                v += update.yaw_H[row, c] * update.W[other, c]
            update.L[row, other] = v
        update.L[row, row] += noise.yaw
    whiten(rows, update)
    subtract_gain(P, rows, update)


@kernel
def linearise(
    x: Array, samples: Array, fresh: Flags, bias: Array,
    body: Body, sensors: Sensors, options: Options, motion: Motion, update: Update,
) -> None:  # fmt: skip
    """Innovations and Jacobian rows of all fresh sensors at the predicted state."""
    orient(x, body, motion)
    if options.accel_sees_motion:
        accelerate(x, body, motion)
    for s in range(sensors.joint.size):
        if not fresh[s]:
            continue
        e = update.innovation[s]
        predicted_sample(s, body, sensors, options, motion, e, update.H[s])
        for i in range(6):
            e[i] = samples[s, i] - e[i]
        for i in range(3):
            e[i] -= bias[s, i]


@kernel
def step(
    x: Array, P: Array, dt: float, jerk: Array, samples: Array, fresh: Flags, bias: Array, rest: Array,
    body: Body, sensors: Sensors, columns: Columns, options: Options, noise: Noise, motion: Motion, update: Update,
) -> None:  # fmt: skip
    """Advance the filter by dt >= 0 and fuse one sample of each fresh sensor.

    x (3, n), P (N, N) are changed in place. samples (S, 6): rad/s and m/s^2 in the sensor frame, fresh (S,),
    bias (S, 3) rad/s, jerk (n,), rest (3, n): variance of the pseudo-measurement "is zero" of each joint's
    position, velocity, acceleration; 0 where there is none. All innovations are taken at the predicted state,
    so that the blocks one after another amount to the joint update.
    """
    if dt > 0.0:
        predict_state(x, dt, jerk)
        predict_covariance(P, dt, noise.jerk, body.translations)
    linearise(x, samples, fresh, bias, body, sensors, options, motion, update)
    update.dx[:] = 0.0
    for s in range(sensors.joint.size):
        if fresh[s]:
            update_sensor(s, P, columns, noise, update)
    if options.yaw_mode > 0:
        update_yaw(P, body, options, motion, noise, update)
    n, t = x.shape[1], body.translations
    for order in range(3):
        for j in range(t, n):
            if rest[order, j] > 0.0:
                col = order * (n - t) + j - t
                update_scalar(P, col, -x[order, j], rest[order, j], update.dx, update.W[0])
    for j in range(n):
        for order in range(3):
            if j >= t:
                x[order, j] += update.dx[order * (n - t) + j - t]
            elif order == 2:
                x[order, j] += update.dx[3 * (n - t) + j]
