"""The waveform of a stride: a Fourier series per channel on one phase, y(W) = sum_k a_k cos kW + b_k sin kW.

`waveform[0, c, k - 1]` is a_k and `waveform[1, c, k - 1]` is b_k of channel c, in rad/s.
"""

from math import cos, pi, sin

from services.biomech.rhythm.compiled import compiled
from services.biomech.rhythm.memory import FloatArray

ALIGNMENT_STEPS = 64


@compiled
def fill_harmonics(phase: float, harmonic: FloatArray) -> None:
    """cos kW and sin kW for k = 1..N, by the addition theorem; error grows with N * 1e-16."""
    cos_1, sin_1 = cos(phase), sin(phase)
    cos_k, sin_k = 1.0, 0.0
    for k in range(harmonic.shape[1]):
        cos_k, sin_k = cos_k * cos_1 - sin_k * sin_1, sin_k * cos_1 + cos_k * sin_1
        harmonic[0, k] = cos_k
        harmonic[1, k] = sin_k


@compiled
def usable_harmonics(frequency: float, harmonics: int, highest_hz: float) -> int:
    """How many of the harmonics of `frequency` (rad/s) lie below the limit, at least one."""
    below = int(2.0 * pi * highest_hz / max(frequency, 1e-3))
    return max(1, min(harmonics, below))


@compiled
def project(
    raw_history: FloatArray,
    newest: int,
    count: int,
    interval_s: float,
    sample_s: float,
    frequency: float,
    harmonics: int,
    waveform: FloatArray,
) -> None:
    """Fourier coefficients of the last `count` cell means, with phase 0 at the newest sample.

    a_k = 2/M sum y cos(k w t), b_k likewise with sin, over whole periods. A cell mean stands for the time
    (interval - sample) / 2 before its end, and has lost the factor sin(x D/2) / (D/T sin(x T/2)) at angular
    frequency x = k w, which is given back (D cell, T sample interval).
    """
    waveform[:] = 0.0
    delay_s = 0.5 * (interval_s - sample_s)
    for c in range(raw_history.shape[0]):
        for k in range(harmonics):
            omega = (k + 1) * frequency
            cos_step, sin_step = cos(omega * interval_s), sin(omega * interval_s)
            cos_t, sin_t = cos(-omega * delay_s), sin(-omega * delay_s)
            cosine, sine = 0.0, 0.0
            for past in range(count):
                value = raw_history[c, newest - past]
                cosine += value * cos_t
                sine += value * sin_t
                cos_t, sin_t = cos_t * cos_step + sin_t * sin_step, sin_t * cos_step - cos_t * sin_step
            droop = sin(0.5 * omega * interval_s) / (interval_s / sample_s * sin(0.5 * omega * sample_s))
            waveform[0, c, k] = 2.0 * cosine / count / droop
            waveform[1, c, k] = 2.0 * sine / count / droop


@compiled
def alignment(template: FloatArray, waveform: FloatArray, phase: float) -> float:
    """Inner product over one period of the template from `phase` on with the waveform from 0 on, (rad/s)^2."""
    total = 0.0
    for k in range(template.shape[2]):
        cos_k, sin_k = cos((k + 1) * phase), sin((k + 1) * phase)
        for c in range(template.shape[1]):
            a, b = template[0, c, k], template[1, c, k]
            total += (a * cos_k + b * sin_k) * waveform[0, c, k] + (b * cos_k - a * sin_k) * waveform[1, c, k]
    return total


@compiled
def best_alignment(template: FloatArray, waveform: FloatArray) -> float:
    """Template phase (rad, 0 to 2 pi) at which the waveform's phase 0 fits best: even steps, then a parabola."""
    step = 2.0 * pi / ALIGNMENT_STEPS
    best, highest = 0, -1e300
    for i in range(ALIGNMENT_STEPS):
        value = alignment(template, waveform, i * step)
        if value > highest:
            best, highest = i, value
    before = alignment(template, waveform, (best - 1) * step)
    after = alignment(template, waveform, (best + 1) * step)
    curvature = before - 2.0 * highest + after
    offset = 0.5 * (before - after) / curvature if curvature < 0.0 else 0.0
    return (best + offset) * step


@compiled
def rotate(waveform: FloatArray, phase: float) -> None:
    """Shift the waveform so that what was at phase 0 is at `phase`."""
    for k in range(waveform.shape[2]):
        cos_k, sin_k = cos((k + 1) * phase), sin((k + 1) * phase)
        for c in range(waveform.shape[1]):
            a, b = waveform[0, c, k], waveform[1, c, k]
            waveform[0, c, k] = a * cos_k - b * sin_k
            waveform[1, c, k] = a * sin_k + b * cos_k


@compiled
def second_derivative(waveform: FloatArray, harmonic: FloatArray, frequency: float, result: FloatArray) -> None:
    """d2y/dt2 = -sum (k lambda)^2 (a_k cos kW + b_k sin kW) of each channel, rad/s^3."""
    for c in range(waveform.shape[1]):
        total = 0.0
        for k in range(waveform.shape[2]):
            value = waveform[0, c, k] * harmonic[0, k] + waveform[1, c, k] * harmonic[1, k]
            total -= (k + 1) * (k + 1) * value
        result[c] = total * frequency * frequency
