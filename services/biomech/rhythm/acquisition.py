"""Between searching, locked and standing: what starts a lock, ends it, and keeps the phase reference across."""

from math import pi

import numpy as np

from services.biomech.rhythm.compiled import compiled
from services.biomech.rhythm.correlator import candidate_stands, find_period, follow_candidate, restart_search
from services.biomech.rhythm.detection import moves, restart_energies, restart_filters, set_walking_energy
from services.biomech.rhythm.memory import LOCKED, SEARCHING, STANDING, Bench, Memory, Record
from services.biomech.rhythm.recall import find_match, is_recognised
from services.biomech.rhythm.waveform import best_alignment, project, rotate, usable_harmonics


@compiled
def search(memory: Memory, bench: Bench, dt_s: float) -> None:
    """Look at the correlation: lock when it has found a period, seed again when the loop has slipped from it."""
    loop, parameters = memory.loop[0], bench.parameters[0]
    spacing_s = parameters.searches_every * parameters.grid_interval_s
    period_s, correlation = find_period(memory, bench)
    follow_candidate(loop, period_s, correlation, spacing_s, parameters)
    stands = candidate_stands(loop, parameters)
    if loop.stage == SEARCHING:
        if not moves(memory.channels, parameters.smallest_rms):
            return
        if stands:
            seed(memory, bench, period_s, dt_s)
            loop.stage = LOCKED
            set_walking_energy(memory.channels, True)
        elif loop.known_frequency > 0.0 and loop.recall_spent == 0.0:
            recognise(memory, bench, dt_s)
        return
    if loop.is_provisional > 0.0:
        if stands:
            judge_recognition(memory, bench, period_s, dt_s)
        return
    if correlation <= parameters.correlation_to_accept:
        return
    if not stands or follows(loop, period_s, parameters.slip_tolerance):
        loop.slip_s = 0.0
        return
    loop.slip_s += spacing_s
    if loop.slip_s > parameters.slip_periods * period_s:
        keep_template(memory)
        seed(memory, bench, period_s, dt_s)


@compiled
def follows(loop: Record, period_s: float, tolerance: float) -> bool:
    """Whether the loop goes at the rate of the correlation, now or at the time the correlation speaks of.

    The correlation looks back: while the speed changes it trails behind a loop that is right.
    """
    turns_per_frequency = period_s / (2.0 * pi)
    now, then = loop.frequency * turns_per_frequency, loop.frequency_mean * turns_per_frequency
    return bool(abs(now - 1.0) <= tolerance or abs(then - 1.0) <= tolerance)


@compiled
def seed(memory: Memory, bench: Bench, period_s: float, dt_s: float) -> None:
    """Waveform from the last periods; phase aligned with the template so that its reference survives.

    Out of a search the phase goes forward by less than a turn, from a slip it takes the nearer way.
    """
    loop, parameters = memory.loop[0], bench.parameters[0]
    interval_s = parameters.grid_interval_s
    history = memory.raw_history.shape[1] // 2
    span_s = parameters.seed_periods * period_s
    if span_s > min(loop.elapsed_s, (history - 2) * interval_s):
        span_s = period_s
    newest = history + (int(loop.grid_count) - 1) % history
    frequency = 2.0 * pi / period_s
    harmonics = usable_harmonics(frequency, memory.waveform.shape[2], parameters.highest_harmonic_hz)
    count = round(span_s / interval_s)
    project(memory.raw_history, newest, count, interval_s, dt_s, frequency, harmonics, memory.waveform)
    # The newest cell ended grid_s ago.
    rotate(memory.waveform, -frequency * loop.grid_s)
    if loop.has_template > 0.0:
        turn = best_alignment(memory.template, memory.waveform) - loop.phase
        turn -= 2.0 * pi * np.floor(turn / (2.0 * pi))
        loop.phase += turn - 2.0 * pi if loop.stage == LOCKED and turn > pi else turn
    rotate(memory.waveform, loop.phase)
    begin_tracking(memory, frequency)


@compiled
def recognise(memory: Memory, bench: Bench, dt_s: float) -> None:
    """Lock provisionally when the motion is the known waveform; the phase goes forward to where it is recognised."""
    loop = memory.loop[0]
    frequency, phase, fit, share = find_match(memory, bench, dt_s)
    if not is_recognised(loop, frequency, phase, fit, share, bench.parameters[0]):
        return
    memory.waveform[:] = memory.known * fit
    turn = phase - loop.phase
    loop.phase += turn - 2.0 * pi * np.floor(turn / (2.0 * pi))
    begin_tracking(memory, frequency)
    loop.quality = share
    loop.residual_power = 1.0 - share
    loop.is_provisional = 1.0
    loop.stage = LOCKED
    set_walking_energy(memory.channels, True)


@compiled
def judge_recognition(memory: Memory, bench: Bench, period_s: float, dt_s: float) -> None:
    """The correlation would lock now: it confirms a provisional lock, or puts its own in its place."""
    loop, parameters = memory.loop[0], bench.parameters[0]
    if not follows(loop, period_s, parameters.slip_tolerance) or loop.quality < parameters.known_quality:
        seed(memory, bench, period_s, dt_s)
    loop.is_provisional = 0.0
    loop.since_lock_s = 0.0


@compiled
def begin_tracking(memory: Memory, frequency: float) -> None:
    """Start the loop's averages from what the correlation says."""
    loop = memory.loop[0]
    loop.frequency = frequency
    loop.frequency_mean = frequency
    loop.quality = loop.correlation
    loop.residual_power = 1.0 - loop.correlation
    loop.signal_power = 1.0
    loop.since_lock_s = 0.0
    loop.slip_s = 0.0


@compiled
def keep_template(memory: Memory) -> None:
    """Remember the waveform: it holds the phase reference for the next seed. A provisional one is not worth it."""
    if memory.loop[0].is_provisional > 0.0:
        return
    memory.template[:] = memory.waveform
    memory.loop[0].has_template = 1.0


@compiled
def keep_known(memory: Memory) -> None:
    """Remember the waveform to recognise the motion by after the next stop."""
    loop = memory.loop[0]
    memory.known[:] = memory.waveform
    loop.known_frequency = loop.frequency_mean
    loop.since_known_s = 0.0


@compiled
def give_up_lock(memory: Memory) -> None:
    """Back to searching; the phase stands still from here."""
    loop = memory.loop[0]
    loop.stage = SEARCHING
    loop.quality = 0.0
    loop.resting_s = 0.0
    loop.is_provisional = 0.0
    set_walking_energy(memory.channels, False)


@compiled
def resume_search(memory: Memory, credit_s: float) -> None:
    """The rest is over: a new search, phase and template kept."""
    restart_search(memory, credit_s)
    restart_energies(memory.channels)
    give_up_lock(memory)


@compiled
def lose_lock(memory: Memory) -> None:
    """The waveform no longer explains the motion: search anew, and trust no known waveform until the next start."""
    if memory.loop[0].is_provisional > 0.0:
        # The search has gone on beside a provisional lock: it goes on as if that had not been.
        give_up_lock(memory)
    else:
        keep_template(memory)
        resume_search(memory, 0.0)
    memory.loop[0].recall_spent = 1.0


@compiled
def stand_still(memory: Memory) -> None:
    """Freeze phase and waveform until the rest ends."""
    keep_template(memory)
    memory.loop[0].stage = STANDING
    memory.loop[0].quality = 0.0
    memory.loop[0].candidate_period_s = 0.0
    memory.loop[0].is_provisional = 0.0


@compiled
def bridge_gap(memory: Memory, bench: Bench, gap_s: float) -> None:
    """Nothing is known of the gap: correlation starts again, the phase coasts if it cannot have lost its place."""
    loop, parameters = memory.loop[0], bench.parameters[0]
    restart_search(memory, 0.0)
    restart_filters(memory.channels, bench.velocity)
    loop.candidate_period_s = 0.0
    loop.grid_s = 0.0
    loop.resting_s = 0.0
    if loop.stage == LOCKED:
        if gap_s * loop.frequency <= pi:
            loop.phase += loop.frequency * (gap_s - parameters.nominal_interval_s)
        else:
            keep_template(memory)
            give_up_lock(memory)
