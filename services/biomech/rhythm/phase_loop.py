"""The phase loop: compare each sample with the waveform, turn the error into phase, frequency and waveform."""

from math import pi

from services.biomech.rhythm.compiled import compiled
from services.biomech.rhythm.memory import FloatArray, Record

ENERGY_FLOOR = 1e-9  # (rad/s)^2, as in the correlator


@compiled
def clip(value: float, low: float, high: float) -> float:
    """`value` within [low, high]."""
    return min(max(value, low), high)


@compiled
def phase_error(
    channels: Record, velocity: FloatArray, waveform: FloatArray, harmonic: FloatArray, filter_gain: float
) -> float:
    """Phase by which the motion is ahead of the waveform, rad, to first order.

    With e = y - yhat and s = dyhat/dW: sum_c w_c e_c s_c / sum_c w_c D_c, where D = sum k^2 (a^2 + b^2) / 2 is the
    mean of s^2, so amplitude and waveform drop out. Leaves e and its filtered copy in the channels.
    """
    numerator, denominator = 0.0, 1e-12
    for c in range(velocity.size):
        channel = channels[c]
        expected, slope, slope_power = 0.0, 0.0, 0.0
        for k in range(waveform.shape[2]):
            a, b = waveform[0, c, k], waveform[1, c, k]
            cos_k, sin_k = harmonic[0, k], harmonic[1, k]
            expected += a * cos_k + b * sin_k
            slope += (k + 1) * (b * cos_k - a * sin_k)
            slope_power += 0.5 * (k + 1) * (k + 1) * (a * a + b * b)
        error = velocity[c] - expected
        channel.error = error
        channel.error_smooth += filter_gain * (error - channel.error_smooth)
        channel.error_filtered += filter_gain * (channel.error_smooth - channel.error_filtered)
        weight = 1.0 / (channel.energy + ENERGY_FLOOR)
        numerator += weight * error * slope
        denominator += weight * slope_power
    return numerator / denominator


@compiled
def follow_quality(loop: Record, channels: Record, dt_s: float, parameters: Record) -> None:
    """Q = 1 - <w e^2> / <w u^2>, both filtered, averaged over `quality_periods`."""
    residual, signal = 0.0, 0.0
    for c in range(channels.size):
        channel = channels[c]
        weight = 1.0 / (channel.energy + ENERGY_FLOOR)
        residual += weight * channel.error_filtered * channel.error_filtered
        signal += weight * channel.filtered * channel.filtered
    periods = parameters.recall_quality_periods if loop.is_provisional > 0.0 else parameters.quality_periods
    gain = dt_s * loop.frequency / (2.0 * pi * periods)
    loop.residual_power += gain * (residual / channels.size - loop.residual_power)
    loop.signal_power += gain * (signal / channels.size - loop.signal_power)
    loop.quality = 1.0 - loop.residual_power / (loop.signal_power + 1e-9)


@compiled
def bandwidth(loop: Record, parameters: Record) -> float:
    """Natural frequency of the loop, rad/s: narrower in noise, wider and not narrowed when the error has one sign.

    A change of speed also raises the variance, so it must not be answered like noise.
    """
    noise = max(loop.phase_error_variance, 1e-4)
    calm = clip((parameters.calm_variance / noise) ** 0.25, parameters.narrowest_share, 1.0)
    systematic = clip((abs(loop.phase_error_mean) - parameters.systematic_error) / 0.3, 0.0, 1.0)
    widest: float = max(parameters.bandwidth_share * loop.frequency, parameters.lowest_bandwidth)
    return widest * (calm + (1.0 - calm) * systematic) * (1.0 + systematic)


@compiled
def correct_phase(loop: Record, error: float, dt_s: float, parameters: Record) -> None:
    """Second-order loop: phase += 1.4 wn pe dt, frequency += wn^2 pe dt."""
    limited = clip(error, -parameters.largest_phase_error, parameters.largest_phase_error)
    per_period = dt_s * loop.frequency / (2.0 * pi)
    # One sample beyond 2 rad says no more than that the phase is lost.
    deviation = clip(error, -2.0, 2.0) - loop.phase_error_mean
    loop.phase_error_variance += per_period / parameters.quality_periods * (deviation**2 - loop.phase_error_variance)
    wn = bandwidth(loop, parameters)
    loop.phase_error_mean += 2.0 * per_period * (limited - loop.phase_error_mean)
    loop.phase += parameters.damping_gain * wn * limited * dt_s
    slowest = 2.0 * pi * 0.85 * parameters.lowest_frequency_hz
    fastest = 2.0 * pi * 1.1 * parameters.highest_frequency_hz
    loop.frequency_mean += per_period / parameters.slip_memory * (loop.frequency - loop.frequency_mean)
    loop.frequency = clip(loop.frequency + wn * wn * limited * dt_s, slowest, fastest)


@compiled
def learn_waveform(
    loop: Record,
    channels: Record,
    waveform: FloatArray,
    harmonic: FloatArray,
    harmonics: int,
    dt_s: float,
    parameters: Record,
) -> None:
    """Gradient step of the coefficients without the part that a shift of phase would explain.

    (da_k, db_k) = g (e (cos kW, sin kW) - rho (k b_k, -k a_k)), rho common to all channels, so that waveform and
    phase do not correct the same error twice; g = 2 dt / (learning periods * T), closed while the quality is poor.
    """
    period_s = 2.0 * pi / loop.frequency
    gain = 2.0 * dt_s / (parameters.learning_periods * period_s)
    gain *= clip((loop.quality - parameters.quality_to_learn) / 0.4, 0.0, 1.0)
    if gain == 0.0:
        return
    along, length = 0.0, 1e-12
    for c in range(channels.size):
        weight = 1.0 / (channels[c].energy + ENERGY_FLOOR)
        error = channels[c].error
        for k in range(harmonics):
            turn_a, turn_b = (k + 1) * waveform[1, c, k], -(k + 1) * waveform[0, c, k]
            along += weight * error * (harmonic[0, k] * turn_a + harmonic[1, k] * turn_b)
            length += weight * (turn_a * turn_a + turn_b * turn_b)
    rho = along / length
    for c in range(channels.size):
        error = channels[c].error
        for k in range(harmonics):
            turn_a, turn_b = (k + 1) * waveform[1, c, k], -(k + 1) * waveform[0, c, k]
            waveform[0, c, k] += gain * (error * harmonic[0, k] - rho * turn_a)
            waveform[1, c, k] += gain * (error * harmonic[1, k] - rho * turn_b)


@compiled
def is_lost(loop: Record, parameters: Record) -> bool:
    """Whether the lock is to be given up; never within the grace after a seed."""
    if loop.is_provisional > 0.0:
        grace = loop.since_lock_s * loop.frequency <= 2.0 * pi * parameters.recall_quality_periods
        return bool(not grace and loop.quality < parameters.recall_quality)
    if loop.since_lock_s * loop.frequency <= 2.0 * pi * parameters.quality_periods:
        return False
    unconfirmed = loop.correlation <= parameters.correlation_to_accept
    return bool(
        loop.quality < parameters.quality_to_unlock or (loop.quality < parameters.quality_to_confirm and unconfirmed)
    )


@compiled
def is_worth_knowing(loop: Record, parameters: Record) -> bool:
    """Whether the waveform has been right for long enough to recognise the motion by, and a period has passed."""
    period_s = 2.0 * pi / loop.frequency
    return bool(
        loop.since_known_s >= period_s
        and loop.is_provisional == 0.0
        and loop.since_lock_s >= parameters.known_periods * period_s
        and loop.quality >= parameters.known_quality
    )


@compiled
def jerk_gate(loop: Record, parameters: Record) -> float:
    """Share of the jerk to believe: opens with the quality and over half a period from the lock."""
    trust = clip((loop.quality - parameters.quality_for_jerk) / 0.35, 0.0, 1.0)
    periods: float = loop.since_lock_s * loop.frequency / (2.0 * pi)
    return trust * min(1.0, 2.0 * periods)
