"""Recognise a waveform that is known already: a lock within a stride instead of two and a half.

The last `recall_periods` of the motion, or less from many joints, are compared with the known waveform g at every
phase W and at frequencies around the known one. With the inner product <u, g> = sum over cells and channels of
w_c u_c g_c, w_c one over the power of the known channel, and a free common amplitude, the explained share is
r = <u, g>^2 / (<u, u> <g, g>). A match is believed when it is good, unlike every other phase, and moves on as it should
from search to search. The lock that follows is provisional: watched more narrowly, and the correlation overrules it at
the instant at which it would have locked by itself.
"""

from math import cos, pi, sin

import numpy as np

from services.biomech.rhythm.compiled import compiled
from services.biomech.rhythm.memory import PHASES, Bench, FloatArray, Memory, Record

FREQUENCIES = 11
"""Frequencies tried from 1 - recall_range to 1 + recall_range times the known one."""
RIVAL_DISTANCE = PHASES // 6
"""Phase steps beyond which another good match makes the phase ambiguous (60 degrees)."""
DEAD_CHANNEL_SHARE = 0.02
"""Of the mean power, the floor of a known channel's power in its weight."""


@compiled
def find_match(memory: Memory, bench: Bench, dt_s: float) -> tuple[float, float, float, float]:
    """Best match of the latest motion: frequency (rad/s), phase now (rad), amplitude ratio, explained share.

    The share is 0 where there is too little motion, the best frequency is the edge of the range, or another phase
    explains nearly as much.
    """
    loop, parameters = memory.loop[0], bench.parameters[0]
    periods = window_periods(memory.channels.size, parameters)
    weights, energy = _prepare(memory.known, bench.turns, round(PHASES * periods))
    shares, fits = np.zeros((FREQUENCIES, PHASES)), np.zeros((FREQUENCIES, PHASES))
    for j in range(FREQUENCIES):
        factor = 1.0 + parameters.recall_range * (2.0 * j / (FREQUENCIES - 1) - 1.0)
        _compare(memory, bench, factor * loop.known_frequency, periods, dt_s, weights, energy, shares[j], fits[j])
    best = int(np.argmax(shares))
    at, phase = best // PHASES, best % PHASES
    share = shares[at, phase]
    if share <= 0.0 or at == 0 or at == FREQUENCIES - 1:
        return 0.0, 0.0, 0.0, 0.0
    for other in range(RIVAL_DISTANCE, PHASES - RIVAL_DISTANCE + 1):
        if shares[at, (phase + other) % PHASES] > share - parameters.recall_margin:
            return 0.0, 0.0, 0.0, 0.0
    step = 2.0 * parameters.recall_range / (FREQUENCIES - 1)
    offset = _vertex(shares[at - 1].max(), share, shares[at + 1].max())
    frequency = loop.known_frequency * (1.0 - parameters.recall_range + step * (at + offset))
    turn = 2.0 * pi / PHASES
    before, after = shares[at, (phase - 1) % PHASES], shares[at, (phase + 1) % PHASES]
    exact = turn * (phase + _vertex(before, share, after))
    return frequency, exact + frequency * loop.grid_s, fits[at, phase], share


@compiled
def window_periods(channels: int, parameters: Record) -> float:
    """Periods of motion that are compared: many joints tell a phase apart sooner than one."""
    return float(min(parameters.recall_periods, parameters.recall_joint_periods / channels))


@compiled
def _prepare(known: FloatArray, turns: FloatArray, window: int) -> tuple[FloatArray, FloatArray]:
    """Weights (C,) of the channels, and power (PHASES,) of the known waveform in the window to a phase."""
    channels, harmonics = known.shape[1], known.shape[2]
    power = np.zeros(channels)
    for c in range(channels):
        for k in range(harmonics):
            power[c] += 0.5 * (known[0, c, k] ** 2 + known[1, c, k] ** 2)
    weights = 1.0 / (power + DEAD_CHANNEL_SHARE * power.mean() + 1e-12)
    momentary = np.zeros(PHASES)
    for i in range(PHASES):
        for c in range(channels):
            value = 0.0
            for k in range(harmonics):
                value += known[0, c, k] * turns[0, i, k] + known[1, c, k] * turns[1, i, k]
            momentary[i] += weights[c] * value * value
    windowed = np.zeros(PHASES)
    for i in range(PHASES):
        for past in range(window):
            windowed[i] += momentary[(i - past) % PHASES] / window
    return weights, windowed


@compiled
def _compare(
    memory: Memory,
    bench: Bench,
    frequency: float,
    periods: float,
    dt_s: float,
    weights: FloatArray,
    energy: FloatArray,
    shares: FloatArray,
    fits: FloatArray,
) -> None:
    """Explained share and amplitude ratio at each phase for one frequency; zeros when the motion is too short."""
    loop, known, interval_s = memory.loop[0], memory.known, bench.parameters[0].grid_interval_s
    history = memory.raw_history.shape[1] // 2
    newest = history + (int(loop.grid_count) - 1) % history
    count = round(periods * 2.0 * pi / frequency / interval_s)
    if count > min(history, int(loop.elapsed_s / interval_s)):
        return
    power = 0.0
    cosine, sine = np.zeros(known.shape[2]), np.zeros(known.shape[2])
    for c in range(known.shape[1]):
        values = memory.raw_history[c, newest - count + 1 : newest + 1]
        power += weights[c] * np.sum(values * values)
        for k in range(known.shape[2]):
            real, imaginary = _project(values, (k + 1) * frequency, interval_s, dt_s)
            a, b = known[0, c, k], known[1, c, k]
            cosine[k] += weights[c] * (a * real - b * imaginary)
            sine[k] += weights[c] * (a * imaginary + b * real)
    for i in range(PHASES):
        product = 0.0
        for k in range(known.shape[2]):
            product += cosine[k] * bench.turns[0, i, k] + sine[k] * bench.turns[1, i, k]
        if product > 0.0:
            fits[i] = product / (count * energy[i] + 1e-12)
            shares[i] = product * fits[i] / (power + 1e-12)


@compiled
def _project(values: FloatArray, omega: float, interval_s: float, dt_s: float) -> tuple[float, float]:
    """Sums of the cell means times cos and sin of omega times their age (s), the newest last.

    A cell's samples stand for the time up to dt before them, so its middle is (interval - dt) / 2 before its end.
    """
    delay_s = 0.5 * (interval_s - dt_s)
    cos_step, sin_step = cos(omega * interval_s), sin(omega * interval_s)
    cos_t, sin_t = cos(omega * delay_s), sin(omega * delay_s)
    real, imaginary = 0.0, 0.0
    for past in range(values.size):
        value = values[values.size - 1 - past]
        real += value * cos_t
        imaginary += value * sin_t
        cos_t, sin_t = cos_t * cos_step - sin_t * sin_step, sin_t * cos_step + cos_t * sin_step
    return real, imaginary


@compiled
def _vertex(before: float, here: float, after: float) -> float:
    """Place of the vertex of the parabola through three points, in steps from the middle one, within +-0.5."""
    curvature = before - 2.0 * here + after
    return min(max(0.5 * (before - after) / curvature, -0.5), 0.5) if curvature < 0.0 else 0.0


@compiled
def is_recognised(loop: Record, frequency: float, phase: float, fit: float, share: float, parameters: Record) -> bool:
    """Whether this match and the one of the search before agree; notes this one."""
    believable = share >= parameters.recall_share
    # The velocity of the same angles grows with the frequency: only the rest is a change of amplitude.
    amplitude = fit * loop.known_frequency / max(frequency, 1e-6)
    believable = believable and 1.0 / parameters.recall_amplitude <= amplitude <= parameters.recall_amplitude
    now_s = loop.grid_count * parameters.grid_interval_s + loop.grid_s
    expected = loop.match_phase + 0.5 * (frequency + loop.match_frequency) * (now_s - loop.match_s)
    apart = abs((phase - expected + pi) % (2.0 * pi) - pi)
    agrees = loop.match_frequency > 0.0 and apart <= parameters.recall_tolerance
    loop.match_frequency = frequency if believable else 0.0
    loop.match_phase = phase
    loop.match_s = now_s
    return bool(believable and agrees)
