"""How a short walk out of standing is scored: strides until the phase is right, wrong phase, phase where it is needed.

There is no stretch long enough to compare frequencies, so phases are compared: right is within 40 degrees of the true
phase plus a constant, which is taken from the last three strides. Where the walk was started from a known rhythm its
own constant is known too, and the difference is the shift of the reference.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.bench.rhythm.motions import INTERVAL_S

FloatArray = NDArray[np.float64]

PHASE, LOCKED = 0, 3
RIGHT = 0.7  # rad
TAIL_STRIDES = 3.0
EARLY_STRIDES = 3.0


@dataclass(frozen=True)
class WarmScore:
    """One walk. Strides are those of the true phase; infinite = never."""

    strides_to_lock: float
    """From the first movement until locked and right for a whole stride."""
    wrong_s: float
    """s locked with a wrong phase."""
    locked_s: float
    early_error: float
    """rad, root mean square over the first three strides, where locked and right; NaN where there is none."""
    strides: int
    strides_with_phase: int
    """Whole strides with lock and a right phase for more than half of their time."""
    reference: float
    """rad: the constant between phase and true phase; NaN without a lock in the last three strides."""


def score_walk(readings: FloatArray, phase: FloatArray, start: int) -> WarmScore:
    """Score readings (n, 4) against the true phase (n,), rad; the person moves from sample `start` on."""
    cycles = (phase - phase[start]) / (2.0 * np.pi)
    locked = readings[:, LOCKED] > 0.5
    ahead = readings[:, PHASE] - phase
    tail = locked & (cycles > cycles[-1] - TAIL_STRIDES)
    reference = float(np.angle(np.mean(np.exp(1j * ahead[tail])))) if tail.any() else np.nan
    error = np.abs(np.angle(np.exp(1j * (ahead - reference))))
    right = locked & (error < RIGHT)
    early = right & (cycles < EARLY_STRIDES)
    strides = int(cycles[-1])
    shares = [np.mean(right[(cycles >= number) & (cycles < number + 1)]) for number in range(strides)]
    return WarmScore(
        strides_to_lock=_first_whole(cycles, right, start),
        wrong_s=float(np.sum(locked & ~right) * INTERVAL_S),
        locked_s=float(np.sum(locked) * INTERVAL_S),
        early_error=float(np.sqrt(np.mean(error[early] ** 2))) if early.any() else np.nan,
        strides=strides,
        strides_with_phase=int(np.sum(np.array(shares) > 0.5)),
        reference=reference,
    )


def _first_whole(cycles: FloatArray, right: NDArray[np.bool_], start: int) -> float:
    """Strides walked when the first stride begins that is right throughout."""
    mistakes = np.concatenate([[0], np.cumsum(~right)])
    end = np.searchsorted(cycles, cycles + 1.0)
    whole = (end < cycles.size) & (mistakes[np.minimum(end, cycles.size)] == mistakes[:-1])
    whole[:start] = False
    return float(cycles[np.argmax(whole)]) if whole.any() else np.inf
