"""How a rhythm is judged against the true one: right frequency, wrong locks, time to lock, recovery, phase."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.bench.rhythm.motions import INTERVAL_S, Motion

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

PHASE, FREQUENCY, QUALITY, LOCKED = range(4)
"""Columns of readings (n, 4)."""

RIGHT = 0.02  # relative frequency error
WRONG = 0.05
WARM_UP_CYCLES = 5.0
TRAILING_CYCLES = 5.0
STOP_RAMP_S = 0.5
STOP_GRACE_S = 1.5


@dataclass(frozen=True)
class RhythmScore:
    """One estimator on one motion. Cycles are strides of the true motion; infinite = never."""

    is_right: bool
    """At least 95 % of the samples after the 5th cycle (and before an event) within 2 % of the true frequency."""
    right_share: float
    """That share of samples."""
    wrong_s: float
    """s declared locked with a frequency more than 5 % off."""
    locked_s: float
    cycles_to_right: float
    """Start of the first full cycle that is right."""
    phase_rms: float
    """rad, without its constant part."""
    final_ratio: float
    """Advance of phase over the true advance, last 10 s."""
    recovery_cycles: float = 0.0
    """From the event until right within 5 % for two cycles."""
    locked_while_standing: float = 0.0
    """Share of the standing time, from 1.5 s after the stop."""
    reference_shift: float = 0.0
    """rad, unsigned: how far the phase reference moved over the event."""


def score_random(motion: Motion, readings: FloatArray) -> RhythmScore:
    """Set R: judged by the frequency given for each sample."""
    cycles = _cycles(motion)
    error = np.abs(readings[:, FREQUENCY] / motion.frequency - 1.0)
    locked = readings[:, LOCKED] > 0.5
    right = error < RIGHT
    share = float(np.mean(right[cycles > WARM_UP_CYCLES]))
    return RhythmScore(
        is_right=share >= 0.95,
        right_share=share,
        wrong_s=float(np.sum(locked & (error > WRONG)) * INTERVAL_S),
        locked_s=float(np.sum(locked) * INTERVAL_S),
        cycles_to_right=_first_full_cycle(cycles, right),
        phase_rms=_phase_rms(motion, readings, cycles),
        final_ratio=_final_ratio(motion, readings),
    )


def score_gait(motion: Motion, readings: FloatArray) -> RhythmScore:
    """Sets of gait: judged by the advance of phase over the trailing cycles, since single cycles are random.

    The frequency is right to lock when one full locked cycle advances the phase by a turn within 2 %.
    """
    cycles = _cycles(motion)
    locked = readings[:, LOCKED] > 0.5
    error = _trailing_error(readings, cycles, locked)
    judged = cycles > WARM_UP_CYCLES
    if motion.event_s is not None:
        judged &= np.arange(cycles.size) * INTERVAL_S < motion.event_s[0]
    one_cycle = _cycles_ahead(readings, cycles, locked, 1, RIGHT)
    first = np.argmax(one_cycle)
    share = float(np.mean(error[judged] < RIGHT))
    return RhythmScore(
        is_right=share >= 0.95,
        right_share=share,
        wrong_s=float(np.sum(locked & np.isfinite(error) & (error > WRONG)) * INTERVAL_S),
        locked_s=float(np.sum(locked) * INTERVAL_S),
        cycles_to_right=float(cycles[first]) if one_cycle.any() else np.inf,
        phase_rms=_phase_rms(motion, readings, cycles),
        final_ratio=_final_ratio(motion, readings),
        recovery_cycles=_recovery(motion, readings, cycles, locked),
        locked_while_standing=_locked_while_standing(motion, locked),
        reference_shift=_reference_shift(motion, readings, locked),
    )


def _cycles(motion: Motion) -> FloatArray:
    return np.asarray((motion.phase - motion.phase[0]) / (2.0 * np.pi))


def _first_full_cycle(cycles: FloatArray, right: BoolArray) -> float:
    """Cycle count at the first sample from which one full cycle is right throughout."""
    mistakes = np.concatenate([[0], np.cumsum(~right)])
    end = np.searchsorted(cycles, cycles + 1.0)
    full = (end < cycles.size) & (mistakes[np.minimum(end, cycles.size)] == mistakes[:-1])
    return float(cycles[np.argmax(full)]) if full.any() else np.inf


def _trailing_error(readings: FloatArray, cycles: FloatArray, locked: BoolArray) -> FloatArray:
    """Relative error of the advance over the last 5 cycles, or since the lock if that is 1 to 5 cycles ago.

    Infinite without lock and within the first cycle after it.
    """
    index = np.arange(cycles.size)
    lock_start = np.maximum.accumulate(np.where(locked & ~np.roll(locked, 1), index, 0))
    start = np.maximum(np.searchsorted(cycles, cycles - TRAILING_CYCLES), lock_start)
    turns = cycles - cycles[start]
    advance = (readings[:, PHASE] - readings[start, PHASE]) / (2.0 * np.pi)
    known = locked & (turns >= 1.0)
    return np.where(known, np.abs(advance / np.maximum(turns, 1e-9) - 1.0), np.inf)


def _cycles_ahead(
    readings: FloatArray, cycles: FloatArray, locked: BoolArray, count: int, tolerance: float
) -> BoolArray:
    """Whether each of the next `count` cycles advances the phase by a turn within the tolerance, all of it locked."""
    unlocked = np.concatenate([[0], np.cumsum(~locked)])
    good = np.ones(cycles.size, dtype=bool)
    start = np.arange(cycles.size)
    for cycle in range(1, count + 1):
        end = np.searchsorted(cycles, cycles + cycle)
        good &= end < cycles.size
        end = np.minimum(end, cycles.size - 1)
        turn = (readings[end, PHASE] - readings[start, PHASE]) / (2.0 * np.pi)
        good &= np.abs(turn - (cycles[end] - cycles[start])) < tolerance
        start = end
    return np.asarray(good & (unlocked[start + 1] == unlocked[:-1]))


def _recovery(motion: Motion, readings: FloatArray, cycles: FloatArray, locked: BoolArray) -> float:
    """Cycles from the restart, or from the change of speed if the rhythm was lost within 10 cycles of it."""
    if motion.event_s is None:
        return 0.0
    begin_s, end_s = motion.event_s
    has_stopped = bool(np.any(np.diff(motion.phase[int(begin_s / INTERVAL_S) : int(end_s / INTERVAL_S)]) == 0.0))
    good = _cycles_ahead(readings, cycles, locked, 2, WRONG)
    event = int((end_s - STOP_RAMP_S if has_stopped else begin_s) / INTERVAL_S)
    first = event
    if not has_stopped:
        lost = event + np.flatnonzero(~good[event:] & (cycles[event:] < cycles[event] + 10.0))
        if lost.size == 0:
            return 0.0
        first = int(lost[0])
    found = np.flatnonzero(good[first:])
    return float(cycles[first + found[0]] - cycles[event]) if found.size else np.inf


def _locked_while_standing(motion: Motion, locked: BoolArray) -> float:
    if motion.event_s is None:
        return 0.0
    standing = locked[
        int((motion.event_s[0] + STOP_GRACE_S) / INTERVAL_S) : int((motion.event_s[1] - STOP_RAMP_S) / INTERVAL_S)
    ]
    return float(np.mean(standing)) if standing.size else 0.0


def _phase_rms(motion: Motion, readings: FloatArray, cycles: FloatArray) -> float:
    judged = (cycles > WARM_UP_CYCLES) & (readings[:, LOCKED] > 0.5)
    if not judged.any():
        return np.inf
    offset = _offset(motion, readings, judged)
    return float(np.sqrt(np.mean(np.angle(np.exp(1j * (_ahead(motion, readings, judged) - offset))) ** 2)))


def _ahead(motion: Motion, readings: FloatArray, judged: BoolArray) -> FloatArray:
    return np.asarray(readings[judged, PHASE] - motion.phase[judged])


def _offset(motion: Motion, readings: FloatArray, judged: BoolArray) -> float:
    """Mean phase difference on the circle, rad."""
    return float(np.angle(np.mean(np.exp(1j * _ahead(motion, readings, judged)))))


def _reference_shift(motion: Motion, readings: FloatArray, locked: BoolArray) -> float:
    if motion.event_s is None:
        return 0.0
    time_s = np.arange(locked.size) * INTERVAL_S
    before, after = locked & (time_s < motion.event_s[0]), locked & (time_s > motion.event_s[1])
    if not (before.any() and after.any()):
        return np.inf
    shift = _offset(motion, readings, after) - _offset(motion, readings, before)
    return float(abs(np.angle(np.exp(1j * shift))))


def _final_ratio(motion: Motion, readings: FloatArray) -> float:
    start = -int(10.0 / INTERVAL_S)
    true_advance = motion.phase[-1] - motion.phase[start]
    return float((readings[-1, PHASE] - readings[start, PHASE]) / true_advance)
