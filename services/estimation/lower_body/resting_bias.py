"""Gyroscope biases followed through a session: what pauses tell about them.

A bias drifts while a sensor warms up, by some tenths of a degree per second within minutes. Where the body is still,
the mean rate over d seconds is the bias but for the sway: a segment whose tilt differs by an angle a between two
instants turns at a / d. The bias is a random walk between pauses, and each pause is one measurement of it: a Kalman
filter with one variance per sensor, shared by its three axes.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from services.estimation.parameters import BiasParameters, StandingParameters
from services.estimation.samples import RATE, Tick
from services.estimation.standing import Sums, is_still
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]


@dataclass
class RestingBias:
    """`bias` (S, 3) rad/s in the sensor frames, as of the newest tick.

    Stillness is judged in blocks as for standing, and sitting still is as good. Of each pause the first and the last
    block are left out. What came before the first movement was the calibration's and does not count again.
    """

    bias: Array
    standing: StandingParameters = field(default_factory=StandingParameters)
    parameters: BiasParameters = field(default_factory=BiasParameters)

    def __post_init__(self) -> None:
        sensors = len(self.bias)
        self._known, self._variance = self.bias, np.full(sensors, self.parameters.start_std**2)
        self._narrowed = self._variance  # of `bias`, while a pause tells it
        self._known_ns: int | None = None
        self._has_moved = False
        self._block: list[Tick] = []
        self._pause_start_ns: int | None = None
        self._held, self._pause = Sums.zero(sensors), Sums.zero(sensors)

    def add(self, tick: Tick) -> bool:
        """Take the next tick; whether `bias` has changed."""
        changed = False
        if self._known_ns is None:
            self._known_ns = tick.captured_ns
        if self._block and tick.captured_ns - self._block[0].captured_ns >= self.standing.block_s * 1e9:
            changed = self._close_block(tick.captured_ns)
            self._block = []
        self._block.append(tick)
        return changed

    def _close_block(self, now_ns: int) -> bool:
        block, block_start_ns = Sums.of(self._block), self._block[0].captured_ns
        rests = is_still(block, self.standing)
        changed = False
        if not rests:
            self._has_moved = True
            self._end_pause(now_ns)
        elif self._has_moved and self._pause_start_ns is None:
            self._pause_start_ns = now_ns
        elif self._pause_start_ns is not None:
            self._pause.add(self._held)
            changed = self._measure((block_start_ns - self._pause_start_ns) / 1e9, now_ns)
            self._held = block
        return changed

    def _end_pause(self, now_ns: int) -> None:
        if self._narrowed is not self._variance:
            self._known, self._variance, self._known_ns = self.bias, self._narrowed, now_ns
            self._narrowed = self._variance
        self._pause_start_ns = None
        self._held, self._pause = Sums.zero(len(self.bias)), Sums.zero(len(self.bias))

    def _measure(self, duration_s: float, now_ns: int) -> bool:
        """The bias as the pause tells it so far: k = p / (p + r), p grown by the drift, r the sway's."""
        if duration_s < self.standing.shortest_s or self._known_ns is None:
            return False
        p = self.parameters
        grown = self._variance + p.drift**2 * (now_ns - self._known_ns) / 1e9
        noise = (self.standing.sway / duration_s) ** 2
        apart = self._pause.mean()[:, RATE] - self._known
        likely = np.sum(apart**2, axis=1) <= 3.0 * p.farthest**2 * (grown + noise)
        gain = np.where(likely & (self._pause.count > 0), grown / (grown + noise), 0.0)
        self.bias = self._known + gain[:, None] * apart
        self._narrowed = grown * (1.0 - gain)
        return True

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "arrays": pack_array(
                np.hstack([self.bias, self._known, self._variance[:, None], self._narrowed[:, None]]),
            ),
            "measured": self._narrowed is not self._variance,
            "known_ns": self._known_ns,
            "pause_start_ns": self._pause_start_ns,
            "has_moved": self._has_moved,
            "ticks_ns": [tick.captured_ns for tick in self._block],
            "samples": pack_array(np.array([tick.samples for tick in self._block])),
            "fresh": [int(flag) for tick in self._block for flag in tick.fresh],
            "sums": [self._held.pack(), self._pause.pack()],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        arrays, sensors = unpack_array(state["arrays"]), len(self.bias)
        self.bias, self._known, self._variance = arrays[:, :3].copy(), arrays[:, 3:6].copy(), arrays[:, 6].copy()
        self._narrowed = arrays[:, 7].copy() if state["measured"] else self._variance
        self._known_ns, self._pause_start_ns = state["known_ns"], state["pause_start_ns"]
        self._has_moved = state["has_moved"]
        samples = unpack_array(state["samples"]).reshape(-1, sensors, 6)
        fresh = np.array(state["fresh"], dtype=np.bool_).reshape(-1, sensors)
        self._block = [Tick(*parts) for parts in zip(state["ticks_ns"], samples, fresh, strict=True)]
        self._held, self._pause = (Sums.unpack(packed) for packed in state["sums"])
