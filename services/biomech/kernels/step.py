"""One step of the filter: predict to the samples' time, then one block per sensor that has a sample."""

from services.biomech.kernels.companions import (
    blend,
    correct,
    expect_headings,
    observe,
    rate_square,
    take,
    weigh,
    wrapped,
)
from services.biomech.kernels.compiled import kernel
from services.biomech.kernels.covariance import (
    innovation_covariance,
    mirror,
    predict_covariance,
    predict_state,
    project,
    subtract_gain,
    whiten,
)
from services.biomech.kernels.fixed import fixed
from services.biomech.kernels.kinematics import accelerate, orient
from services.biomech.kernels.measurement import (
    column,
    dynamic_rows,
    gravity_rows,
    gyro_rows,
    subtract_from,
    yaw_row,
)
from services.biomech.kernels.tables import (
    Array,
    Body,
    Columns,
    Companions,
    Flags,
    Motion,
    Noise,
    Options,
    Sensors,
    Update,
)

NOMINAL_DT_S = 0.01
"""s. Virtual measurements are stated for 100 Hz; at other rates their variance is scaled so that the information
they give per second stays the same."""


@kernel
def predicted_sample(
    s: int, body: Body, sensors: Sensors, options: Options, motion: Motion, z: Array, H: Array
) -> None:
    """z (6,) and H (6, N) of one sensor: angular velocity, then specific force. Needs the recursions before."""
    gyro_rows(s, body, sensors, options, motion, z, H)
    if options.accel_sees_motion:
        dynamic_rows(s, body, sensors, motion, z, H)
    else:
        gravity_rows(s, body, sensors, motion, z, H)


@kernel
def fuse(P: Array, complete: int, H: Array, innovation: Array, variance: Array, update: Update) -> None:
    """Fuse six rows whose W = H P is there."""
    innovation_covariance(H, innovation, variance, update)
    whiten(update)
    subtract_gain(P, complete, update)


@kernel
def update_sensor(s: int, P: Array, columns: Columns, noise: Noise, companions: Companions, update: Update) -> None:
    """Block of six rows: three of the gyroscope, three of the accelerometer."""
    H = update.H[s]
    project(P, H, 0, columns.gyro[s], columns.gyro_count[s], update)
    project(P, H, 3, columns.accel[s], columns.accel_count[s], update)
    fuse(P, columns.complete, H, update.innovation[s], noise.sample[s], update)
    companions.squared[0, s] = rate_square(update.y)
    for c in range(companions.x.shape[0]):
        correct(c, H, companions.innovation[c, s], companions, update)
        companions.squared[c + 1, s] = rate_square(companions.y)


@kernel
def yaw_rows(
    P: Array, body: Body, columns: Columns, options: Options, motion: Motion, variance: float,
    companions: Companions, update: Update,
) -> int:  # fmt: skip
    """The virtual yaw measurement (Joukov eq. 22) as the first virtual rows; how many there are.

    Yaw is measured as zero, so that slow gyro drift about the vertical does not turn the legs.
    """
    H, e, bodies = update.virtual_H, update.virtual_innovation, options.yaw_bodies
    if options.yaw_mode == 1:
        rows = 3
        for i in range(3):
            e[i] = -yaw_row(bodies[i], body, motion, 1.0, H[i])
    else:
        rows = 2
        pelvis = yaw_row(bodies[0], body, motion, -1.0, H[0])
        H[1] = H[0]
        for i in range(2):
            e[i] = wrapped(pelvis - yaw_row(bodies[i + 1], body, motion, 1.0, H[i]))
    for i in range(rows):
        update.virtual_variance[i] = variance
    expect_headings(options, companions)
    project(P, H, 0, columns.yaw, columns.yaw.size, update)
    return rows


@kernel
def fuse_virtual(P: Array, complete: int, rows: int, companions: Companions, update: Update) -> None:
    """Fuse the virtual rows collected in `update`, and clear them."""
    W, H = fixed(update.W, update.width), fixed(update.virtual_H, update.width)
    for i in range(rows, 6):
        for k in range(W.shape[1]):
            W[i, k] = 0.0
        update.virtual_innovation[i] = 0.0
        update.virtual_variance[i] = 1.0
        companions.virtual_innovation[:, i] = 0.0
    fuse(P, complete, update.virtual_H, update.virtual_innovation, update.virtual_variance, update)
    for c in range(companions.x.shape[0]):
        correct(c, update.virtual_H, companions.virtual_innovation[c], companions, update)
    for i in range(6):
        for k in range(H.shape[1]):
            H[i, k] = 0.0


@kernel
def copy_row(P: Array, c: int, complete: int, row: Array) -> None:
    """Row c of the covariance. Of the rows that are not complete, the column holds what is up to date."""
    if c < complete:
        for k in range(P.shape[1]):
            row[k] = P[c, k]
    else:
        for k in range(P.shape[0]):
            row[k] = P[k, c]


@kernel
def rest_rows(
    x: Array, P: Array, rest: Array, share: float, rows: int, translations: int, complete: int,
    companions: Companions, update: Update,
) -> int:  # fmt: skip
    """Measurements of single states as zero, behind the `rows` there are; six at a time are fused."""
    for order in range(3):
        for j in range(translations, x.shape[1]):
            if rest[order, j] <= 0.0:
                continue
            c = column(order, j, translations, x.shape[1])
            update.virtual_H[rows, c] = 1.0
            update.virtual_innovation[rows] = -x[order, j]
            for i in range(companions.x.shape[0]):
                companions.virtual_innovation[i, rows] = -companions.x[i, order, j]
            update.virtual_variance[rows] = rest[order, j] * share
            copy_row(P, c, complete, update.W[rows])
            rows += 1
            if rows == 6:
                fuse_virtual(P, complete, rows, companions, update)
                rows = 0
    return rows


@kernel
def update_virtual(
    x: Array, P: Array, rest: Array, share: float,
    body: Body, columns: Columns, options: Options, noise: Noise, motion: Motion,
    companions: Companions, update: Update,
) -> None:  # fmt: skip
    """Yaw and rest measurements; `share` makes their information per second the same at every rate."""
    rows = 0
    if options.yaw_mode > 0:
        rows = yaw_rows(P, body, columns, options, motion, noise.yaw * share, companions, update)
    rows = rest_rows(x, P, rest, share, rows, body.translations, columns.complete, companions, update)
    if rows > 0:
        fuse_virtual(P, columns.complete, rows, companions, update)


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
        subtract_from(s, samples, bias, options.force_bound, e)


@kernel
def impact_jerk(dt: float, fresh: Flags, noise: Noise, update: Update) -> float:
    """Least jerk density, rad^2/s^5: 0 unless a gyroscope is farther off its prediction than any movement explains.

    Jerk j over dt adds e = j dt^2 / 2 to a rate, and white jerk of density S has the variance S / dt in an interval:
    with S = 4 e^2 / (k^2 dt^3) the innovation e is k standard deviations.
    """
    largest = 0.0
    for s in range(fresh.size):
        if fresh[s]:
            e = update.innovation[s]
            largest = max(largest, e[0] * e[0] + e[1] * e[1] + e[2] * e[2])
    if largest <= noise.impact_rate * noise.impact_rate:
        return 0.0
    return 4.0 * largest / (noise.impact_deviations * noise.impact_deviations * dt * dt * dt)


@kernel
def step(
    x: Array, P: Array, dt: float, jerk: Array, samples: Array, fresh: Flags, bias: Array, rest: Array,
    body: Body, sensors: Sensors, columns: Columns, options: Options, noise: Noise, motion: Motion, update: Update,
    companions: Companions,
) -> None:  # fmt: skip
    """Advance the filter by dt >= 0 and fuse one sample of each fresh sensor.

    x (3, n), P (N, N) are changed in place. samples (S, 6): rad/s and m/s^2 in the sensor frame, fresh (S,),
    bias (S, 3) rad/s, jerk (n,), rest (3, n): variance at 100 Hz of the pseudo-measurement "is zero" of each
    joint's position, velocity, acceleration; 0 where there is none. All innovations are taken at the predicted state,
    so that the blocks one after another amount to the joint update. Companions come along with x, see `companions.py`.
    """
    if dt > 0.0:
        predict_state(x, dt, jerk)
        for c in range(companions.x.shape[0]):
            predict_state(companions.x[c], dt, companions.jerk[c])
    observe(samples, fresh, bias, body, sensors, options, motion, companions)
    linearise(x, samples, fresh, bias, body, sensors, options, motion, update)
    if dt > 0.0:
        least = impact_jerk(dt, fresh, noise, update)
        predict_covariance(P, dt, noise.jerk, least, body.translations, columns.complete, update.width)
    update.dx[:] = 0.0
    for s in range(sensors.joint.size):
        if fresh[s]:
            update_sensor(s, P, columns, noise, companions, update)
    if dt > 0.0:
        update_virtual(x, P, rest, NOMINAL_DT_S / dt, body, columns, options, noise, motion, companions, update)
    mirror(P)
    n, t = x.shape[1], body.translations
    for j in range(n):
        for order in range(3):
            if j >= t or order == 2:
                x[order, j] += update.dx[column(order, j, t, n)]
    take(t, companions)
    weigh(fresh, dt, companions)
    blend(x, companions)
