"""The flexion axis by principal components of the relative angular velocity, sample by sample.

McGrath et al. 2018, eq. 1: the relative angular velocity of a hinge lies along its axis. The scatter of it is kept in
the frame of each sensor and forgotten over motion, so that the axis may wander; one power iteration a sample from the
axis before finds the first component and keeps its sign.
"""

from math import sqrt

from services.biomech.two_sensor_knee.compiled import compiled
from services.biomech.two_sensor_knee.memory import SHANK, THIGH, Bench, FloatArray, Memory


@compiled
def follow_axis(memory: Memory, bench: Bench, dt_s: float) -> bool:
    """Add the sample's relative rate to both scatters and move both axes; False when it is too slow to tell."""
    knee, parameters, relative, rate = memory.knee[0], bench.parameters[0], bench.midway, bench.rate
    in_thigh = (
        relative[0, 0] * rate[1, 0] + relative[0, 1] * rate[1, 1] + relative[0, 2] * rate[1, 2] - rate[0, 0],
        relative[1, 0] * rate[1, 0] + relative[1, 1] * rate[1, 1] + relative[1, 2] * rate[1, 2] - rate[0, 1],
        relative[2, 0] * rate[1, 0] + relative[2, 1] * rate[1, 1] + relative[2, 2] * rate[1, 2] - rate[0, 2],
    )
    in_shank = (
        relative[0, 0] * in_thigh[0] + relative[1, 0] * in_thigh[1] + relative[2, 0] * in_thigh[2],
        relative[0, 1] * in_thigh[0] + relative[1, 1] * in_thigh[1] + relative[2, 1] * in_thigh[2],
        relative[0, 2] * in_thigh[0] + relative[1, 2] * in_thigh[1] + relative[2, 2] * in_thigh[2],
    )
    square = in_thigh[0] ** 2 + in_thigh[1] ** 2 + in_thigh[2] ** 2
    if square < parameters.moving_rate**2:
        return False
    keep = max(0.0, 1.0 - dt_s / parameters.axis_memory_s)
    if knee.moving_s == 0.0:
        begin_axes(memory, bench, in_thigh, in_shank, sqrt(square))
    knee.moving_s = keep * knee.moving_s + dt_s
    add_scatter(memory.scatter[THIGH], in_thigh, keep, dt_s)
    add_scatter(memory.scatter[SHANK], in_shank, keep, dt_s)
    for s in range(2):
        iterate(memory.scatter[s], memory.axes[s])
        straighten(memory.across[s], memory.axes[s])
    return True


@compiled
def begin_axes(
    memory: Memory,
    bench: Bench,
    in_thigh: tuple[float, float, float],
    in_shank: tuple[float, float, float],
    length: float,
) -> None:
    """Both axes along the first relative rate, whose sign is the same for both; this pose becomes angle 0.

    `across` is the part of the vertical perpendicular to the axis (of a horizontal direction if the axis is upright),
    so that nothing depends on how the sensors are mounted.
    """
    axes, across = memory.axes, memory.across
    for i in range(3):
        axes[THIGH, i] = in_thigh[i] / length
        axes[SHANK, i] = in_shank[i] / length
    R = bench.R[THIGH]
    upright = R[1, 0] * axes[THIGH, 0] + R[1, 1] * axes[THIGH, 1] + R[1, 2] * axes[THIGH, 2]
    across[THIGH, :] = R[1] if abs(upright) < 0.9 else R[0]
    straighten(across[THIGH], axes[THIGH])
    for k in range(3):
        across[SHANK, k] = 0.0
        for i in range(3):
            across[SHANK, k] += bench.relative[i, k] * across[THIGH, i]


@compiled
def add_scatter(scatter: FloatArray, rate: tuple[float, float, float], keep: float, dt_s: float) -> None:
    """scatter = keep scatter + rate rate' dt."""
    for i in range(3):
        for j in range(3):
            scatter[i, j] = keep * scatter[i, j] + rate[i] * rate[j] * dt_s


@compiled
def iterate(scatter: FloatArray, axis: FloatArray) -> None:
    """One power iteration: axis = scatter axis / norm."""
    x = scatter[0, 0] * axis[0] + scatter[0, 1] * axis[1] + scatter[0, 2] * axis[2]
    y = scatter[1, 0] * axis[0] + scatter[1, 1] * axis[1] + scatter[1, 2] * axis[2]
    z = scatter[2, 0] * axis[0] + scatter[2, 1] * axis[1] + scatter[2, 2] * axis[2]
    length = sqrt(x * x + y * y + z * z)
    if length > 1e-12:
        axis[0], axis[1], axis[2] = x / length, y / length, z / length


@compiled
def straighten(across: FloatArray, axis: FloatArray) -> None:
    """Make `across` a unit vector perpendicular to the axis again, by the smallest turn."""
    along = across[0] * axis[0] + across[1] * axis[1] + across[2] * axis[2]
    x, y, z = across[0] - along * axis[0], across[1] - along * axis[1], across[2] - along * axis[2]
    length = sqrt(x * x + y * y + z * z)
    if length > 1e-6:
        across[0], across[1], across[2] = x / length, y / length, z / length


@compiled
def axis_deviation(memory: Memory, bench: Bench) -> float:
    """Standard deviation of the axis, rad.

    Off-axis motion of share q = minor / major moves the axis by sqrt(q correlation time / moving time) as far as it
    is random, and by a share of sqrt(q) as far as it repeats with the motion.
    """
    knee, parameters = memory.knee[0], bench.parameters[0]
    if knee.moving_s <= 0.0:
        return 1.5
    worst = 0.0
    for s in range(2):
        scatter, axis = memory.scatter[s], memory.axes[s]
        total = scatter[0, 0] + scatter[1, 1] + scatter[2, 2]
        major = 0.0
        for i in range(3):
            for j in range(3):
                major += axis[i] * scatter[i, j] * axis[j]
        worst = max(worst, (total - major) / max(major, 1e-12))
    # One correlation time of motion has seen a single direction: it looks perfect and says nothing.
    share = max(worst, 0.0) + (parameters.axis_correlation_s / knee.moving_s) ** 2
    random = share * parameters.axis_correlation_s / knee.moving_s
    return min(1.5, sqrt(parameters.axis_floor**2 + random + share * parameters.axis_systematic_share**2))
