"""The flexion axis by principal components of the relative angular velocity, sample by sample.

McGrath et al. 2018, eq. 1: the relative angular velocity of a hinge lies along its axis. The scatter of it is kept in
the frame of each sensor and forgotten over motion, so that the axis may wander; one power iteration every now and
then from the axis before finds the first component and keeps its sign.
"""

from math import sqrt

from services.biomech.two_sensor_knee.compiled import compiled
from services.biomech.two_sensor_knee.memory import SHANK, THIGH, Bench, FloatArray, Memory

UNKNOWN_STD = 1.5
"""rad. Of an axis that nothing is known of."""


@compiled
def follow_axis(memory: Memory, bench: Bench, dt_s: float) -> bool:
    """Add the sample's relative rate to both scatters; False when it is too slow to tell."""
    knee, parameters, relative, rate = memory.knee, bench.parameters, bench.midway, bench.rate
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
        begin_axes(memory, in_thigh, in_shank, sqrt(square))
    knee.moving_s = keep * knee.moving_s + dt_s
    add_scatter(memory.scatter[THIGH], in_thigh, keep, dt_s)
    add_scatter(memory.scatter[SHANK], in_shank, keep, dt_s)
    follow_late_axis(memory, in_thigh, in_shank, dt_s, parameters.slip_time_s)
    return True


@compiled
def follow_late_axis(
    memory: Memory,
    in_thigh: tuple[float, float, float],
    in_shank: tuple[float, float, float],
    dt_s: float,
    time_s: float,
) -> None:
    """Scatter of the relative rate (rad/s, in either sensor) in the last `time_s` of motion."""
    slip = memory.slip
    keep = max(0.0, 1.0 - dt_s / time_s)
    slip.moving_s = keep * slip.moving_s + dt_s
    add_scatter(slip.scatter[THIGH], in_thigh, keep, dt_s)
    add_scatter(slip.scatter[SHANK], in_shank, keep, dt_s)


@compiled
def improve_axes(memory: Memory, bench: Bench) -> None:
    """Move both axes towards the first components, and say how well they are known."""
    for s in range(2):
        iterate(memory.scatter[s], memory.axes[s])
        straighten(memory.across[s], memory.axes[s])
    memory.knee.axis_std = axis_deviation(memory, bench)
    if memory.knee.has_angle == 0.0:
        pair_axes(memory, bench)


@compiled
def pair_axes(memory: Memory, bench: Bench) -> None:
    """Give the shank's axis the sense of the thigh's: a first rate across the axis leaves them free to part."""
    along = 0.0
    for i in range(3):
        for k in range(3):
            along += memory.axes[THIGH, i] * bench.relative[i, k] * memory.axes[SHANK, k]
    if along < 0.0:
        for k in range(3):
            memory.axes[SHANK, k] *= -1.0


@compiled
def begin_axes(
    memory: Memory, in_thigh: tuple[float, float, float], in_shank: tuple[float, float, float], length: float
) -> None:
    """Both axes along the first relative rate: whatever their sense, it is the same for both."""
    for i in range(3):
        memory.axes[THIGH, i] = in_thigh[i] / length
        memory.axes[SHANK, i] = in_shank[i] / length
    memory.knee.axis_std = UNKNOWN_STD


@compiled
def begin_angle(memory: Memory, bench: Bench) -> None:
    """This pose becomes angle 0: `across` is one direction in both segments.

    It is the part of the vertical perpendicular to the axis (of a horizontal direction if the axis is upright), so
    that nothing depends on how the sensors are mounted.
    """
    axes, across, R = memory.axes, memory.across, bench.R[THIGH]
    upright = R[1, 0] * axes[THIGH, 0] + R[1, 1] * axes[THIGH, 1] + R[1, 2] * axes[THIGH, 2]
    row = 1 if abs(upright) < 0.9 else 0
    for i in range(3):
        across[THIGH, i] = R[row, i]
    straighten(across[THIGH], axes[THIGH])
    for k in range(3):
        across[SHANK, k] = 0.0
        for i in range(3):
            across[SHANK, k] += bench.relative[i, k] * across[THIGH, i]
    straighten(across[SHANK], axes[SHANK])
    memory.knee.has_angle = 1.0


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
    knee, parameters = memory.knee, bench.parameters
    if knee.moving_s <= 0.0:
        return UNKNOWN_STD
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
    return min(UNKNOWN_STD, sqrt(parameters.axis_floor**2 + random + share * parameters.axis_systematic_share**2))
