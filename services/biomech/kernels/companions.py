"""States beside the filter's own that expect another motion, and how far each is believed.

With the same process noise, covariances and gains of two filters are all but equal. So a second filter is no more than
a second state with its own prediction and innovations, corrected with the gain of the first; the rows are linearised at
the first state, which thereby stays exactly what it would be alone. A companion may take a smaller part of the
corrections: that is a filter with less process noise, but for the covariance.

Companions are stacked, each bolder than the level below, and believed as far as the gyroscopes of a group of sensors
say that it predicts better (`evidence.py`).
"""

import numpy as np

from services.biomech.kernels.compiled import inlined, kernel
from services.biomech.kernels.evidence import bold_share
from services.biomech.kernels.fixed import fixed
from services.biomech.kernels.kinematics import accelerate, orient
from services.biomech.kernels.measurement import column, expected_sample, forward_axis, subtract_from, yaw_of
from services.biomech.kernels.tables import Array, Body, Companions, Flags, Motion, Options, Sensors, Update

TURN = 2.0 * np.pi


@inlined
def wrapped(angle: float) -> float:
    """The angle within half a turn of zero."""
    return angle - TURN * np.floor(angle / TURN + 0.5)  # type: ignore[no-any-return]


@kernel
def observe(
    samples: Array, fresh: Flags, bias: Array,
    body: Body, sensors: Sensors, options: Options, motion: Motion, companions: Companions,
) -> None:  # fmt: skip
    """Innovations and headings of all companions at their predicted states. `motion` is overwritten."""
    for c in range(companions.x.shape[0]):
        orient(companions.x[c], body, motion)
        if options.accel_sees_motion:
            accelerate(companions.x[c], body, motion)
        for s in range(sensors.joint.size):
            if fresh[s]:
                e = companions.innovation[c, s]
                expected_sample(s, sensors, options, motion, e)
                subtract_from(s, samples, bias, options.force_bound, e)
        for i in range(3):
            companions.heading[c, i] = yaw_of(forward_axis(options.yaw_bodies[i], motion))


@kernel
def expect_headings(options: Options, companions: Companions) -> None:
    """Innovations of the virtual yaw rows, which are the first of the virtual rows."""
    for c in range(companions.x.shape[0]):
        heading, e = companions.heading[c], companions.virtual_innovation[c]
        if options.yaw_mode == 1:
            e[0], e[1], e[2] = -heading[0], -heading[1], -heading[2]
        else:
            e[0], e[1] = wrapped(heading[0] - heading[1]), wrapped(heading[0] - heading[2])


@kernel
def correct(c: int, H: Array, innovation: Array, companions: Companions, update: Update) -> None:
    """dx += W' y with y = inv(L) (innovation - H dx), for six rows that the filter's own state has just fused."""
    H, W = fixed(H, update.width), fixed(update.W, update.width)
    dx, L, y = fixed(companions.dx, update.width)[c], update.L, companions.y
    for i in range(6):
        left = innovation[i]
        for k in range(W.shape[1]):
            left -= H[i, k] * dx[k]
        y[i] = left
    for i in range(6):
        left = y[i]
        for j in range(i):
            left -= L[i, j] * y[j]
        y[i] = left * L[i, i]
    a, b, d, e, f, g = y[0], y[1], y[2], y[3], y[4], y[5]
    for k in range(W.shape[1]):
        dx[k] += W[0, k] * a + W[1, k] * b + W[2, k] * d + W[3, k] * e + W[4, k] * f + W[5, k] * g


@inlined
def rate_square(y: Array) -> float:
    """Squared innovation of a gyroscope, whitened: the first three rows of a sensor's block.

    Accelerometers are left out: their innovations are the motion that a gravity sensor must not see.
    """
    total: float = y[0] * y[0] + y[1] * y[1] + y[2] * y[2]
    return total


@kernel
def take(translations: int, companions: Companions) -> None:
    """Each companion takes its part of its correction; the collected corrections are cleared."""
    n = companions.x.shape[2]
    for c in range(companions.x.shape[0]):
        for order in range(3):
            for j in range(n):
                if j >= translations or order == 2:
                    dx = companions.dx[c, column(order, j, translations, n)]
                    companions.x[c, order, j] += companions.part[c, order, j] * dx
        companions.dx[c] = 0.0


@kernel
def weigh(fresh: Flags, dt: float, companions: Companions) -> None:
    """Follow the evidence of every group that has a sample."""
    memory, doubt, refusal = companions.gate
    for c in range(companions.x.shape[0]):
        for g in range(companions.member.shape[0]):
            difference, heard = 0.0, 0.0
            for s in range(companions.member.shape[1]):
                if fresh[s]:
                    heard += companions.member[g, s]
                    apart = companions.squared[c, s] - companions.squared[c + 1, s]
                    difference += companions.member[g, s] * apart
            if heard > 0.0 and dt > 0.0:
                evidence = companions.evidence[c, g]
                companions.weight[c, g] = bold_share(evidence, difference, dt, memory, doubt, refusal)


@kernel
def blend(x: Array, companions: Companions) -> None:
    """From the filter's own state towards each bolder one, as far as it and all below it are believed."""
    estimate = companions.estimate
    estimate[:] = x
    for j in range(x.shape[1]):
        g = companions.group[j]
        if g < 0:
            continue
        believed = 1.0
        for c in range(companions.x.shape[0]):
            believed *= companions.weight[c, g]
            for order in range(3):
                below = companions.x[c - 1, order, j] if c > 0 else x[order, j]
                estimate[order, j] += believed * (companions.x[c, order, j] - below)
