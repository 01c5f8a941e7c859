"""Less process noise where the learned rhythm explains the acceleration (named as future work by Joukov et al.).

    share = clip(factor <d(e)^2> / <d(u)^2>, floor, 1),   S -> S (1 - gate (1 - share))

u is the joint velocity, e its part that the waveform does not explain, both low-passed by the rhythm's detection
filter, d their difference from sample to sample (so acceleration up to a factor) and <> the mean over 1.5 strides.
`gate` is the share of the jerk that is believed: without lock nothing changes.
"""

from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from services.biomech.rhythm.memory import LOCKED
from services.biomech.rhythm.phase_loop import clip, jerk_gate
from services.biomech.single_joint.compiled import compiled

FloatArray = NDArray[np.float64]

ERROR_BEFORE, UNEXPLAINED, POWER = range(3)
"""Slots of the memory (3,): rad/s, (rad/s)^2 per sample, (rad/s)^2 per sample."""


@dataclass(frozen=True)
class AdaptiveNoise:
    """Tunables of the process noise that follows the rhythm. Off unless asked for.

    By itself it harms: a walker's strides differ by 2 to 5 % and how the next one differs is not known beforehand, so
    that a filter told to expect little is late exactly where it matters (acceleration of knees up to twice as
    wrong). Therefore it is a filter of its own that has to prove itself against the rhythm with constant noise through
    the innovation gate. So guarded it was harmless on every kind of motion of `ambula bench joukov`, but
    it costs that third filter.
    """

    factor: float = 4.0
    """S per unexplained share; above 1 because the share is measured below 5 Hz only. Chosen among 2, 4, 8, 20, 40."""
    floor: float = 0.01
    """Least share of S. Chosen among 0.01, 0.03, 0.1."""
    periods: float = 1.5
    """Averaging of the powers, in strides."""


@compiled
def noise_share(
    memory: FloatArray,
    loop: Any,
    channel: Any,
    dt_s: float,
    factor: float,
    floor: float,
    periods: float,
    parameters: Any,
) -> float:
    """Factor for the process noise of the interval that follows, floor to 1; follows the powers in `memory`.

    `loop`, `channel` and `parameters` are records of the rhythm that has just taken a sample.
    """
    unexplained = channel.error_filtered - memory[ERROR_BEFORE]
    memory[ERROR_BEFORE] = channel.error_filtered
    if loop.stage != LOCKED:
        memory[UNEXPLAINED], memory[POWER] = 0.0, 0.0
        return 1.0
    change = channel.filtered - channel.filtered_before
    gain = max(dt_s * loop.frequency / (2.0 * pi * periods), dt_s / (loop.since_lock_s + dt_s))
    memory[UNEXPLAINED] += gain * (unexplained * unexplained - memory[UNEXPLAINED])
    memory[POWER] += gain * (change * change - memory[POWER])
    share = clip(factor * memory[UNEXPLAINED] / (memory[POWER] + 1e-12), floor, 1.0)
    return 1.0 - jerk_gate(loop, parameters) * (1.0 - share)
