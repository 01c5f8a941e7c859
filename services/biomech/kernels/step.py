"""One step of the filter: predict to the samples' time, then one block per sensor that has a sample."""

import numpy as np

from services.biomech.kernels.compiled import kernel
from services.biomech.kernels.covariance import (
    innovation_covariance,
    predict_covariance,
    predict_state,
    project,
    subtract_gain,
    whiten,
)
from services.biomech.kernels.kinematics import accelerate, orient
from services.biomech.kernels.measurement import (
    column,
    dynamic_rows,
    gravity_rows,
    gyro_rows,
    place_sensor,
    yaw_row,
)
from services.biomech.kernels.tables import Array, Body, Columns, Flags, Motion, Noise, Options, Sensors, Update

NOMINAL_DT_S = 0.01
"""s. Virtual measurements are stated for 100 Hz; at other rates their variance is scaled so that the information
they give per second stays the same."""


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
    innovation_covariance(H, e, 6, update)
    for i in range(3):
        update.L[i, i] += noise.gyro[s]
        update.L[3 + i, 3 + i] += noise.accel[s]
    whiten(6, update)
    subtract_gain(P, 6, update)


@kernel
def yaw_rows(
    P: Array,
    body: Body,
    columns: Columns,
    options: Options,
    motion: Motion,
    noise: Noise,
    share: float,
    update: Update,
) -> int:
    """The virtual yaw measurement (Joukov eq. 22) as the first virtual rows; how many there are.

    Yaw is measured as zero, so that slow gyro drift about the vertical does not turn the legs.
    """
    H, e, bodies = update.virtual_H, update.virtual_innovation, options.yaw_bodies
    rows = 3 if options.yaw_mode == 1 else 2
    for i in range(rows):
        for c in columns.yaw:
            H[i, c] = 0.0
        if rows == 3:
            e[i] = -yaw_row(bodies[i], body, motion, 1.0, H[i])
        else:
            pelvis = yaw_row(bodies[0], body, motion, -1.0, H[i])
            thigh = yaw_row(bodies[i + 1], body, motion, 1.0, H[i])
            e[i] = (pelvis - thigh + np.pi) % (2.0 * np.pi) - np.pi
        update.virtual_variance[i] = noise.yaw * share
    project(P, H, 0, rows, columns.yaw, columns.yaw.size, update.W)
    return rows


@kernel
def update_virtual(P: Array, rows: int, update: Update) -> None:
    """Fuse the virtual rows collected in `update`, and clear them."""
    innovation_covariance(update.virtual_H, update.virtual_innovation, rows, update)
    for i in range(rows):
        update.L[i, i] += update.virtual_variance[i]
    whiten(rows, update)
    subtract_gain(P, rows, update)
    update.virtual_H[:rows] = 0.0


@kernel
def rest_rows(x: Array, P: Array, rest: Array, share: float, rows: int, translations: int, update: Update) -> int:
    """Measurements of single states as zero, behind the `rows` there are; six at a time are fused."""
    n, W = x.shape[1], update.W
    for order in range(3):
        for j in range(translations, n):
            if rest[order, j] <= 0.0:
                continue
            c = column(order, j, translations, n)
            update.virtual_H[rows, c] = 1.0
            update.virtual_innovation[rows] = -x[order, j]
            update.virtual_variance[rows] = rest[order, j] * share
            for k in range(P.shape[1]):
                W[rows, k] = P[c, k]
            rows += 1
            if rows == 6:
                update_virtual(P, rows, update)
                rows = 0
    return rows


@kernel
def fuse_virtual(
    x: Array, P: Array, rest: Array, share: float,
    body: Body, columns: Columns, options: Options, noise: Noise, motion: Motion, update: Update,
) -> None:  # fmt: skip
    """Yaw and rest measurements; `share` makes their information per second the same at every rate."""
    rows = 0
    if options.yaw_mode > 0:
        rows = yaw_rows(P, body, columns, options, motion, noise, share, update)
    rows = rest_rows(x, P, rest, share, rows, body.translations, update)
    if rows > 0:
        update_virtual(P, rows, update)


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
    bias (S, 3) rad/s, jerk (n,), rest (3, n): variance at 100 Hz of the pseudo-measurement "is zero" of each
    joint's position, velocity, acceleration; 0 where there is none. All innovations are taken at the predicted state,
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
    if dt > 0.0:
        fuse_virtual(x, P, rest, NOMINAL_DT_S / dt, body, columns, options, noise, motion, update)
    n, t = x.shape[1], body.translations
    for j in range(n):
        for order in range(3):
            if j >= t or order == 2:
                x[order, j] += update.dx[column(order, j, t, n)]
