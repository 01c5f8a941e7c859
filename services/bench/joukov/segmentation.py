"""How well a phase cuts a movement into its repetitions, and how well its frequency is known."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Mask = NDArray[np.bool_]

TURN = 2.0 * np.pi
TOLERANCE = 0.1
"""Share of a repetition by which a boundary may be off."""


def boundaries(time_s: FloatArray, phase: FloatArray) -> FloatArray:
    """Times at which an unwrapped phase, rad, completes a turn for the first time, s."""
    risen = np.maximum.accumulate(phase)
    turns = np.floor(risen / TURN)
    at = np.flatnonzero(np.diff(turns) > 0)
    share = (turns[at + 1] * TURN - risen[at]) / (risen[at + 1] - risen[at])
    return np.asarray(time_s[at] + share * (time_s[at + 1] - time_s[at]))


def phase_against(phase: FloatArray, truth: FloatArray, locked: Mask) -> FloatArray:
    """The phase, turned by the one constant that brings it closest to the truth while it is locked.

    A rhythm's phase counts from wherever it first locked on. The published oscillator may turn backwards.
    """
    forward = phase if phase[-1] >= phase[0] else -phase
    used = locked if np.any(locked) else np.ones_like(locked)
    return np.asarray(forward - np.angle(np.mean(np.exp(1j * (forward - truth)[used]))))


def segmented_right(found_s: FloatArray, true_s: FloatArray) -> FloatArray:
    """For each repetition between true boundaries: 1 where exactly its two boundaries were found, each within
    TOLERANCE of the repetition, and none between them; else 0."""
    right = []
    for start_s, end_s in pairwise(true_s.tolist()):
        within = TOLERANCE * (end_s - start_s)
        near = found_s[(found_s >= start_s - within) & (found_s <= end_s + within)]
        right.append(len(near) == 2 and near[0] <= start_s + within and near[1] >= end_s - within)
    return np.array(right, dtype=np.float64)


def segmentation(time_s: FloatArray, phase: FloatArray, locked: Mask, truth: FloatArray) -> FloatArray:
    """`segmented_right` of a phase (n,) against the true phase (n,), rad; where it is not locked, it cuts nothing."""
    found_s = boundaries(time_s, phase_against(phase, truth, locked))
    is_locked = locked[np.clip(np.searchsorted(time_s, found_s), 0, len(time_s) - 1)]
    return segmented_right(found_s[is_locked], boundaries(time_s, truth))


def mean_frequency(frequency: FloatArray, locked: Mask) -> float:
    """Mean of the frequency while it is locked, rad/s; NaN where it never is."""
    return float(np.mean(frequency[locked])) if np.any(locked) else float("nan")


def percent_error(value: float, truth: float) -> float:
    """As published: truth minus value, in percent of the truth."""
    return 100.0 * (truth - value) / truth
