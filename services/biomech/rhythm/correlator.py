"""The period of a motion from its normalised square difference, with a memory of a few lags and pooled over joints.

n(tau) = 2 sum_c w_c r_c(tau) / sum_c w_c m_c(tau), where r_c and m_c are the fading sums of u(t) u(t - tau) and
u(t)^2 + u(t - tau)^2 (McLeod and Wyvill's NSDF, made recursive). It is 1 for an exact period and -1 for an exact
half-wave; 1 - n is the unexplained share whatever the amplitude.
"""

import numpy as np

from services.biomech.rhythm.compiled import compiled
from services.biomech.rhythm.memory import Bench, FloatArray, Memory, Record

ENERGY_FLOOR = 1e-9  # (rad/s)^2, keeps the weight of a dead channel finite


@compiled
def ends_cell(loop: Record, channels: Record, velocity: FloatArray, dt_s: float, parameters: Record) -> bool:
    """Whether the sample reaches the next point of the even grid; if not, it is added to the cell begun."""
    if loop.grid_s + dt_s > parameters.grid_interval_s - 1e-9:
        return True
    loop.grid_s += dt_s
    for c in range(velocity.size):
        channels[c].cell += velocity[c] * dt_s
    return False


@compiled
def fill_grid(memory: Memory, bench: Bench, dt_s: float) -> int:
    """Carry a sample that ends one cell or more to the even grid, whatever its own interval; the points passed.

    The velocity is held over (t - dt, t] and averaged per grid cell; the filtered velocity is interpolated.
    """
    loop = memory.loop[0]
    interval_s = bench.parameters[0].grid_interval_s
    remaining_s = dt_s
    points = 0
    while loop.grid_s + remaining_s > interval_s - 1e-9:
        share_s = interval_s - loop.grid_s
        remaining_s = max(remaining_s - share_s, 0.0)
        _end_cell(memory, bench, share_s, 1.0 - remaining_s / dt_s)
        loop.grid_s = 0.0
        loop.grid_count += 1.0
        points += 1
    loop.grid_s = remaining_s
    for c in range(bench.velocity.size):
        memory.channels[c].cell = bench.velocity[c] * remaining_s
    return points


@compiled
def _end_cell(memory: Memory, bench: Bench, share_s: float, into_interval: float) -> None:
    """Close the cell with `share_s` of the sample; the grid point lies at `into_interval` (0 to 1) of its interval."""
    grid_count = int(memory.loop[0].grid_count)
    raw_slot = grid_count % (memory.raw_history.shape[1] // 2)
    slot = grid_count % (memory.filtered_history.shape[1] // 2)
    for c in range(bench.velocity.size):
        channel = memory.channels[c]
        raw = (channel.cell + bench.velocity[c] * share_s) / bench.parameters[0].grid_interval_s
        filtered = channel.filtered_before + into_interval * (channel.filtered - channel.filtered_before)
        _keep(memory.raw_history[c], raw_slot, raw)
        _keep(memory.filtered_history[c], slot, filtered)
        _correlate(memory.products[c], memory.squares[c], memory.filtered_history[c], slot, bench.forgetting)
        channel.cell = 0.0


@compiled
def _keep(history: FloatArray, slot: int, value: float) -> None:
    history[slot] = value
    history[slot + history.size // 2] = value


@compiled
def _correlate(
    products: FloatArray, squares: FloatArray, history: FloatArray, slot: int, forgetting: FloatArray
) -> None:
    newest = slot + history.size // 2
    value = history[newest]
    power = value * value
    for lag in range(1, products.size):
        past = history[newest - lag]
        products[lag] = forgetting[lag] * products[lag] + value * past
        squares[lag] = forgetting[lag] * squares[lag] + power + past * past


@compiled
def find_period(memory: Memory, bench: Bench) -> tuple[float, float]:
    """The shortest period (s) among the high peaks of n, and n there; (0, 0) when there is none.

    n(T/2) / n(T) = 1 - 2 rho_odd whatever the noise, rho_odd being the share of power in odd harmonics, so the
    threshold `shortest_period_share` alone decides between stride and step.
    """
    parameters, correlation = bench.parameters[0], bench.correlation
    interval_s = parameters.grid_interval_s
    first = int(0.9 / parameters.highest_frequency_hz / interval_s)
    last = min(correlation.size - 1, int(memory.loop[0].elapsed_s / interval_s / parameters.seen_lags))
    if last < first + 3:
        return 0.0, 0.0
    _pool(memory, first - 1, last, correlation)
    highest = 0.0
    for lag in range(first, last):
        if _is_peak(correlation, lag):
            highest = max(highest, correlation[lag])
    if highest <= 0.0:
        return 0.0, 0.0
    lag = first
    while not (_is_peak(correlation, lag) and correlation[lag] >= parameters.shortest_period_share * highest):
        lag += 1
    return (lag + _peak_offset(correlation, lag)) * interval_s, correlation[lag]


@compiled
def _pool(memory: Memory, first: int, last: int, correlation: FloatArray) -> None:
    correlation[first : last + 1] = 0.0
    norm = np.full(last + 1 - first, 1e-12)
    for c in range(memory.channels.size):
        weight = 1.0 / (memory.channels[c].energy + ENERGY_FLOOR)
        for lag in range(first, last + 1):
            correlation[lag] += weight * memory.products[c, lag]
            norm[lag - first] += weight * memory.squares[c, lag]
    for lag in range(first, last + 1):
        correlation[lag] *= 2.0 / norm[lag - first]


@compiled
def _is_peak(values: FloatArray, at: int) -> bool:
    return bool(values[at] > values[at - 1] and values[at] >= values[at + 1])


@compiled
def _peak_offset(values: FloatArray, at: int) -> float:
    """Vertex of the parabola through three points, in steps from the middle one, within +-0.5 at a peak."""
    before, here, after = values[at - 1], values[at], values[at + 1]
    curvature = before - 2.0 * here + after
    return 0.5 * (before - after) / curvature if curvature < 0.0 else 0.0


@compiled
def follow_candidate(loop: Record, period_s: float, correlation: float, spacing_s: float, parameters: Record) -> None:
    """Note what the search found, and for how long it has been saying so."""
    loop.correlation = correlation
    if period_s <= 0.0 or correlation <= parameters.correlation_to_accept:
        loop.candidate_s = 0.0
        return
    before_s = loop.candidate_period_s
    if before_s > 0.0 and abs(period_s / before_s - 1.0) < parameters.candidate_tolerance:
        loop.candidate_s += spacing_s
    else:
        loop.candidate_s = 0.0
    loop.candidate_period_s = period_s


@compiled
def candidate_stands(loop: Record, parameters: Record) -> bool:
    """Whether the candidate is confirmed now, has been for long enough, on enough data."""
    period_s = loop.candidate_period_s
    return bool(
        period_s > 0.0
        and loop.correlation > parameters.correlation_to_accept
        and loop.candidate_s >= parameters.candidate_periods * period_s
        and loop.elapsed_s >= parameters.periods_to_lock * period_s
    )


@compiled
def restart_search(memory: Memory, credit_s: float) -> None:
    """Forget all correlation; `credit_s` of the motion to search has already gone by. The candidate starts afresh."""
    loop = memory.loop[0]
    memory.products[:] = 0.0
    memory.squares[:] = 0.0
    loop.elapsed_s = credit_s
    loop.candidate_s = 0.0
    loop.correlation = 0.0
    loop.recall_spent = 0.0
    loop.match_frequency = 0.0
