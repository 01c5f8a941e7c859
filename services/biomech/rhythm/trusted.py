"""A rhythm estimator that knows whether it may be believed.

Acquisition decides (every local method, gradient or Kalman, ends in an optimum near its start), so the period is
searched globally by correlation; a normalised phase loop then follows it, and the correlation keeps watch. Steps of
one sample, in the order of `advance`:

1. bounds and gaps of the input                  this file
2. detection filter, energies, rest              detection.py
3. correlation on an even 25 Hz grid, period     correlator.py
4. lock, seed of the waveform, stop, restart     acquisition.py, waveform.py
5. recognition of a waveform known already       recall.py
6. phase loop, coefficients, lock quality        phase_loop.py
7. gated jerk                                    this file
"""

from math import pi

import numpy as np
from numpy.typing import NDArray

from services.biomech.rhythm.acquisition import (
    bridge_gap,
    keep_known,
    lose_lock,
    resume_search,
    search,
    stand_still,
)
from services.biomech.rhythm.compiled import compiled
from services.biomech.rhythm.correlator import ends_cell, fill_grid
from services.biomech.rhythm.detection import (
    filter_velocity,
    follow_energies,
    follow_walking_energy,
    low_pass_gain,
    rests,
)
from services.biomech.rhythm.memory import (
    LOCKED,
    SEARCHING,
    STANDING,
    Bench,
    FloatArray,
    Memory,
    Record,
    allocate_memory,
    pack_memory,
    prepare_bench,
    unpack_memory,
)
from services.biomech.rhythm.parameters import TrustedParameters
from services.biomech.rhythm.phase_loop import (
    correct_phase,
    follow_quality,
    is_lost,
    is_worth_knowing,
    jerk_gate,
    learn_waveform,
    phase_error,
)
from services.biomech.rhythm.reading import RhythmReading
from services.biomech.rhythm.waveform import fill_harmonics, second_derivative, usable_harmonics
from services.flow.node import State


@compiled
def advance(memory: Memory, bench: Bench, velocity: FloatArray, dt_s: float) -> None:
    """Take one sample (rad/s, shape (C,), dt_s after the one before) into the memory; leaves the jerk in the bench.

    A sample that is not finite counts as missing. Intervals of 0 or less are no time and change nothing.
    Only what is rare gets the whole memory: handing it on costs more than the arithmetic.
    """
    loop, channels, parameters = memory.loop[0], memory.channels, bench.parameters[0]
    interval_s = usable_interval(loop, velocity, dt_s, parameters, bench.velocity)
    if interval_s <= 0.0:
        return
    if interval_s > parameters.gap_s:
        bridge_gap(memory, bench, interval_s)
        interval_s = parameters.nominal_interval_s
    bench.jerk[:] = 0.0
    loop.elapsed_s += interval_s
    filter_gain = low_pass_gain(parameters.detection_cutoff_hz, interval_s)
    filter_velocity(channels, bench.velocity, filter_gain)
    follow_energies(channels, loop.elapsed_s, interval_s, loop.stage == STANDING, parameters)
    is_search_due = False
    if ends_cell(loop, channels, bench.velocity, interval_s, parameters):
        points = fill_grid(memory, bench, interval_s)
        is_search_due = int(loop.grid_count) % int(parameters.searches_every) < points
    if loop.stage == STANDING:
        if not rests(channels, 2.0 * parameters.rest_share):
            resume_search(memory, parameters.restart_credit_s)
        return
    if loop.stage == LOCKED:
        if has_stopped(loop, channels, interval_s, parameters):
            stand_still(memory)
            return
        follow_walking_energy(channels, interval_s, parameters)
        loop.phase += loop.frequency * interval_s
    if is_search_due:
        search(memory, bench, interval_s)
    if loop.stage == LOCKED:
        waveform, harmonic = memory.waveform, bench.harmonic
        track(loop, channels, waveform, harmonic, bench.velocity, interval_s, filter_gain, parameters)
        if is_worth_knowing(loop, parameters):
            keep_known(memory)
        if is_lost(loop, parameters):
            lose_lock(memory)
        else:
            expect_jerk(loop, waveform, harmonic, interval_s, parameters, bench.jerk)


@compiled
def usable_interval(loop: Record, velocity: FloatArray, dt_s: float, parameters: Record, bounded: FloatArray) -> float:
    """s since the last sample that was used, 0 when this one cannot be; copies it within +-largest_velocity."""
    if not dt_s > 0.0:
        return 0.0
    interval_s = dt_s + loop.unused_s
    for c in range(velocity.size):
        if np.isnan(velocity[c]):
            loop.unused_s = interval_s
            return 0.0
        bounded[c] = min(max(velocity[c], -parameters.largest_velocity), parameters.largest_velocity)
    loop.unused_s = 0.0
    return float(interval_s)


@compiled
def has_stopped(loop: Record, channels: Record, dt_s: float, parameters: Record) -> bool:
    """Whether all channels have rested for `rest_periods`."""
    loop.resting_s = loop.resting_s + dt_s if rests(channels, parameters.rest_share) else 0.0
    return bool(loop.resting_s * loop.frequency > 2.0 * pi * parameters.rest_periods)


@compiled
def track(
    loop: Record,
    channels: Record,
    waveform: FloatArray,
    harmonic: FloatArray,
    velocity: FloatArray,
    dt_s: float,
    filter_gain: float,
    parameters: Record,
) -> None:
    """Compare the sample with the waveform at the phase predicted for it; judge, learn, correct."""
    loop.since_lock_s += dt_s
    loop.since_known_s += dt_s
    harmonics = usable_harmonics(loop.frequency, waveform.shape[2], parameters.highest_harmonic_hz)
    fill_harmonics(loop.phase, harmonic)
    error = phase_error(channels, velocity, waveform, harmonic, filter_gain)
    follow_quality(loop, channels, dt_s, parameters)
    learn_waveform(loop, channels, waveform, harmonic, harmonics, dt_s, parameters)
    correct_phase(loop, error, dt_s, parameters)


@compiled
def expect_jerk(
    loop: Record, waveform: FloatArray, harmonic: FloatArray, dt_s: float, parameters: Record, jerk: FloatArray
) -> None:
    """Gated second derivative of the waveform in the middle of the interval that follows."""
    gate = jerk_gate(loop, parameters)
    if gate > 0.0:
        fill_harmonics(loop.phase + 0.5 * loop.frequency * dt_s, harmonic)
        second_derivative(waveform, harmonic, loop.frequency, jerk)
        jerk *= gate


@compiled
def advance_many(memory: Memory, bench: Bench, velocity: FloatArray, dt_s: float, readings: FloatArray) -> None:
    """`advance` over velocity (n, C); readings (n, 4) get phase, frequency, quality, locked."""
    for i in range(velocity.shape[0]):
        advance(memory, bench, velocity[i], dt_s)
        read(memory.loop[0], readings[i])


@compiled
def advance_and_read(memory: Memory, bench: Bench, velocity: FloatArray, dt_s: float) -> None:
    """`advance`, and the reading (phase, frequency, quality, locked) left in the bench."""
    advance(memory, bench, velocity, dt_s)
    read(memory.loop[0], bench.reading)


@compiled
def read(loop: Record, reading: FloatArray) -> None:
    """What may be shown: the candidate's frequency while searching, 0 while standing; quality only in lock."""
    locked = loop.stage == LOCKED
    reading[0] = loop.phase
    reading[1] = loop.frequency if locked else 0.0
    if loop.stage == SEARCHING and loop.candidate_period_s > 0.0:
        reading[1] = 2.0 * pi / loop.candidate_period_s
    reading[2] = min(max(loop.quality, 0.0), 1.0) if locked else 0.0
    reading[3] = 1.0 if locked else 0.0


class TrustedRhythm:
    """Rhythm of joints that share one stride, with a lock that can be trusted (see the head of this file).

    Sample intervals may vary; gaps above `gap_s` are bridged or end the lock. Needs 2.5 periods to lock, or less than
    one when it knows the waveform: from `start_from`, or from before a stop.
    """

    def __init__(self, channels: int, parameters: TrustedParameters = TrustedParameters()) -> None:  # noqa: B008 (frozen)
        self.channels = channels
        self._memory = allocate_memory(channels, parameters)
        self._bench = prepare_bench(channels, parameters)

    def step(self, velocity: NDArray[np.float64], dt_s: float) -> RhythmReading:
        """Take one sample: rad/s, shape (channels,), dt_s after the sample before."""
        advance_and_read(self._memory, self._bench, velocity, dt_s)
        phase, frequency, quality, locked = self._bench.reading.tolist()
        return RhythmReading(phase, frequency, quality, locked > 0.0, self._bench.jerk.copy())

    def run(self, velocity: NDArray[np.float64], dt_s: float) -> NDArray[np.float64]:
        """Take evenly spaced samples, rad/s, shape (n, channels); phase, frequency, quality, locked as (n, 4)."""
        readings = np.zeros((velocity.shape[0], 4))
        advance_many(self._memory, self._bench, np.ascontiguousarray(velocity), dt_s, readings)
        return readings

    def start_from(self, waveform: NDArray[np.float64], frequency: float) -> None:
        """Know a waveform before the first sample.

        Args:
            waveform: rad/s, shape (2, channels, any number of harmonics): cosine and sine coefficients.
            frequency: rad/s of the stride it was learned at.

        Its phase is the reference from here on. It has to be recognised before it is believed.
        """
        harmonics = min(waveform.shape[2], self._memory.known.shape[2])
        self._memory.known[:] = 0.0
        self._memory.known[:, :, :harmonics] = waveform[:, :, :harmonics]
        self._memory.template[:] = self._memory.known
        loop = self._memory.loop[0]
        loop["has_template"], loop["known_frequency"] = 1.0, frequency

    def snapshot(self) -> State:
        """Everything that changes, as JSON values."""
        return pack_memory(self._memory)

    def restore(self, state: State) -> None:
        """Go on from a snapshot of an estimator with the same channels and parameters."""
        unpack_memory(state, self._memory)
