"""Filtering for detection only: energies that weigh the channels, and the sign of rest."""

from math import exp, pi

from services.biomech.rhythm.compiled import compiled
from services.biomech.rhythm.memory import FloatArray, Record


@compiled
def low_pass_gain(cutoff_hz: float, dt_s: float) -> float:
    """Gain of an exact one-pole low-pass over one interval."""
    return 1.0 - exp(-2.0 * pi * cutoff_hz * dt_s)


@compiled
def filter_velocity(channels: Record, velocity: FloatArray, gain: float) -> None:
    """Two one-pole low-passes on each channel."""
    for c in range(velocity.size):
        channel = channels[c]
        channel.filtered_before = channel.filtered
        channel.smooth += gain * (velocity[c] - channel.smooth)
        channel.filtered += gain * (channel.smooth - channel.filtered)


@compiled
def follow_energies(channels: Record, elapsed_s: float, dt_s: float, standing: bool, parameters: Record) -> None:
    """Running means of u^2; a fresh start averages evenly until the time constant is reached. Held while standing."""
    even = dt_s / (elapsed_s + dt_s)
    slow = max(dt_s / parameters.energy_time_s, even)
    fast = max(dt_s / parameters.recent_energy_time_s, even)
    for c in range(channels.size):
        channel = channels[c]
        power = channel.filtered * channel.filtered
        channel.recent_energy += fast * (power - channel.recent_energy)
        if not standing:
            channel.energy += slow * (power - channel.energy)


@compiled
def follow_walking_energy(channels: Record, dt_s: float, parameters: Record) -> None:
    """The energy rest is judged against, learned in lock."""
    gain = dt_s / parameters.energy_time_s
    for c in range(channels.size):
        channel = channels[c]
        channel.walking_energy += gain * (channel.filtered * channel.filtered - channel.walking_energy)


@compiled
def set_walking_energy(channels: Record, known: bool) -> None:
    """Begin it from the slow energy at a lock, forget it at an unlock."""
    for c in range(channels.size):
        channels[c].walking_energy = channels[c].energy if known else 0.0


@compiled
def restart_energies(channels: Record) -> None:
    """A new search weighs the channels by what they did of late."""
    for c in range(channels.size):
        channels[c].energy = channels[c].recent_energy


@compiled
def rests(channels: Record, share: float) -> bool:
    """Whether every channel is below `share` of its walking RMS."""
    for c in range(channels.size):
        channel = channels[c]
        if channel.filtered * channel.filtered > share * share * channel.walking_energy:
            return False
    return True


@compiled
def moves(channels: Record, smallest_rms: float) -> bool:
    """Whether any channel has an RMS above `smallest_rms` (rad/s)."""
    largest = 0.0
    for c in range(channels.size):
        largest = max(largest, channels[c].energy)
    return largest > smallest_rms * smallest_rms


@compiled
def restart_filters(channels: Record, velocity: FloatArray) -> None:
    """After a gap: filters settled at the first value seen, nothing of the time before."""
    for c in range(velocity.size):
        channel = channels[c]
        channel.smooth = channel.filtered = channel.filtered_before = velocity[c]
        channel.cell = channel.error_smooth = channel.error_filtered = 0.0
