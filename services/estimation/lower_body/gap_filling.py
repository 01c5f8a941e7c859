"""Closing a short gap from both ends: what a sensor did not deliver is interpolated as soon as it is back.

While a sensor is silent the filter extrapolates, and its covariance grows; within a stride accelerometers measure far
more than gravity, and a filter that is unsure believes them. With the second sample after the gap its course is known
well: the cubic through its ends, with the slopes that two samples on either side tell. The filter is then set back to
before the gap and taken through the same ticks again with the filled samples. What was published stays; from now on it
is right.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.lower_body_ekf import LowerBodyEkf
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

MISSED = 1.5
"""Sample intervals after which the next sample counts as missing."""
NEAREST = 0.6
"""Sample intervals between filled samples, and to the ends: the ticks of other hubs lie in between."""
LONGEST_WAY_S = 1.0
"""s of ticks that are kept at most, where one gap opens before the last is closed."""


class Step(NamedTuple):
    """What the filter was given for one tick."""

    captured_ns: int
    dt_s: float
    samples: Array  # (S, 6)
    fresh: Flags  # (S,)
    jerk: Array  # (n,) rad/s^3
    driven: Array  # jerk of the companions
    led: Array  # (n,) rad by which joints were led afterwards


class GapFilling:
    """Advances the filter, and again through gaps that have closed. Sensors have `rates_hz` (S,)."""

    def __init__(self, ekf: LowerBodyEkf, rates_hz: Sequence[float], longest_s: float) -> None:
        self._ekf = ekf
        self._interval_ns = [round(1e9 / rate) for rate in rates_hz]
        self._longest_ns = round(longest_s * 1e9)
        count = len(rates_hz)
        # Each sensor's last two samples, and the first after a gap; and their times.
        self._said: list[list[Array]] = [[] for _ in range(count)]
        self._heard: list[list[int]] = [[] for _ in range(count)]
        self._saved: dict[str, Array] | None = None
        self._steps: list[Step] = []

    def advance(self, step: Step, measured: Flags, rest: Array) -> None:
        """Predict and fuse as the filter does; then again from before a gap that this tick has closed.

        `measured` (S,): whose samples are no stand-ins; rest (3, n) as the filter takes it.
        """
        now_ns = step.captured_ns
        spoken, is_open = measured.tolist(), False
        for s, heard in enumerate(self._heard):
            if heard and now_ns - heard[-1] > self._longest_ns:
                self._forget(s)
            is_open = is_open or self._is_open(s, now_ns)
        for s in np.flatnonzero(step.fresh & ~measured).tolist() if is_open else ():
            self._forget(s)
        if self._saved is None and is_open:
            self._saved = self._save()
        if self._saved is not None:
            self._steps += self._in_between(step)
        self._ekf.advance(step.dt_s, step.samples, step.fresh, step.jerk, rest)
        closed = [self._hear(s, step) for s, is_new in enumerate(spoken) if is_new]
        if self._saved is not None:
            self._catch_up(now_ns, any(closed), rest)

    def lead(self, way: Array) -> None:
        """After the newest tick joints were led by this way (n,), rad."""
        if self._steps:
            self._steps[-1].led[:] = way

    def clear(self) -> None:
        """The filter was changed otherwise: no way leads through that."""
        self._saved = None
        self._steps.clear()
        for s in range(len(self._heard)):
            self._forget(s)

    def _forget(self, s: int) -> None:
        self._heard[s].clear()
        self._said[s].clear()

    def _is_open(self, s: int, now_ns: int) -> bool:
        """Whether a gap of this sensor is not filled yet: silent now, or its second sample is still awaited."""
        heard = self._heard[s]
        return len(heard) == 3 or (len(heard) == 2 and now_ns - heard[1] > MISSED * self._interval_ns[s])

    def _hear(self, s: int, step: Step) -> bool:
        """Take a sample; whether it is the second after a gap, which is filled now."""
        heard, said = self._heard[s], self._said[s]
        heard.append(step.captured_ns)
        said.append(step.samples[s])
        closed = len(heard) == 4
        if closed:
            self._fill(s)
            del heard[0], said[0]
        if len(heard) == 3 and heard[2] - heard[1] <= MISSED * self._interval_ns[s]:
            del heard[0], said[0]
        return closed

    def _fill(self, s: int) -> None:
        """Cubic Hermite interpolation between the second and third of four samples, into the ticks between them."""
        times = [(ns - self._heard[s][1]) * 1e-9 for ns in self._heard[s]]
        span = times[2]
        before, first, second, after = self._said[s]
        rise_before = (first - before) / -times[0] * span
        rise_after = (after - second) / (times[3] - span) * span
        apart_ns = NEAREST * self._interval_ns[s]
        latest_ns, end_ns = self._heard[s][1], self._heard[s][2]
        for step in self._steps:
            if step.captured_ns - latest_ns < apart_ns or end_ns - step.captured_ns < apart_ns:
                continue
            latest_ns = step.captured_ns
            u = (latest_ns - self._heard[s][1]) * 1e-9 / span
            v = 1.0 - u
            step.samples[s] = (1 + 2 * u) * v * v * first + u * u * (3 - 2 * u) * second
            step.samples[s] += u * v * v * rise_before - u * u * v * rise_after
            step.fresh[s] = True

    def _in_between(self, step: Step) -> list[Step]:
        """A copy of the step; where nobody was heard before it, in as many steps as there were samples."""
        count = max(round(step.dt_s * 1e9 / min(self._interval_ns)), 1)
        width_ns = round(step.dt_s * 1e9) / count
        silent = [
            Step(
                step.captured_ns - round((count - k) * width_ns), step.dt_s / count,
                np.zeros_like(step.samples), np.zeros_like(step.fresh), step.jerk.copy(), step.driven.copy(),
                np.zeros_like(step.led),
            )
            for k in range(1, count)
        ]  # fmt: skip
        last = step._replace(dt_s=step.dt_s / count, samples=step.samples.copy(), fresh=step.fresh.copy())
        return [*silent, last._replace(jerk=step.jerk.copy(), driven=step.driven.copy())]

    def _catch_up(self, now_ns: int, closed: bool, rest: Array) -> None:
        """Where a gap was closed, go the way again; keep what the gaps need that are still open."""
        opened = [heard[1] for s, heard in enumerate(self._heard) if self._is_open(s, now_ns)]
        if closed:
            self._go_again(min(opened, default=now_ns), rest)
        if not opened:
            self._saved = None
            self._steps.clear()
        elif now_ns - self._steps[0].captured_ns > LONGEST_WAY_S * 1e9:
            self.clear()

    def _go_again(self, keep_ns: int, rest: Array) -> None:
        """From the saved state to the present, saving the state at the last tick that is not after `keep_ns`."""
        assert self._saved is not None
        self._load(self._saved)
        kept = sum(step.captured_ns <= keep_ns for step in self._steps)
        for i, step in enumerate(self._steps, start=1):
            self._ekf.companions.jerk[:] = step.driven
            self._ekf.advance(step.dt_s, step.samples, step.fresh, step.jerk, rest)
            self._ekf.shift(step.led)
            if i == kept:
                self._saved = self._save()
        del self._steps[:kept]

    def _state(self) -> dict[str, Array]:
        c = self._ekf.companions
        return {
            "x": self._ekf.x, "P": self._ekf.P, "companions": c.x, "jerk": c.jerk,
            "evidence": c.evidence, "weight": c.weight, "estimate": c.estimate,
        }  # fmt: skip

    def _save(self) -> dict[str, Array]:
        return {name: array.copy() for name, array in self._state().items()}

    def _load(self, saved: dict[str, Array]) -> None:
        for name, array in self._state().items():
            array[...] = saved[name]

    def snapshot(self) -> State:
        """What was heard of late, and the way since the oldest open gap."""
        saved = self._saved
        return {
            "heard": [list(heard) for heard in self._heard],
            "said": [pack_array(np.array(said).reshape(-1, 6)) for said in self._said],
            "saved": None if saved is None else {name: pack_array(array) for name, array in saved.items()},
            "steps": [
                [ns, dt_s, *(pack_array(a) for a in (samples, fresh.astype(np.float64), *rest))]
                for ns, dt_s, samples, fresh, *rest in self._steps
            ],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._heard = [list(heard) for heard in state["heard"]]
        self._said = [list(unpack_array(said)) for said in state["said"]]
        saved = state["saved"]
        like = self._state()
        self._saved = (
            None if saved is None else {name: unpack_array(a).reshape(like[name].shape) for name, a in saved.items()}
        )
        self._steps = [self._unpacked(*packed) for packed in state["steps"]]

    def _unpacked(self, captured_ns: int, dt_s: float, *packed: State) -> Step:
        samples, fresh, jerk, driven, led = (unpack_array(array) for array in packed)
        driven = driven.reshape(self._ekf.companions.jerk.shape)
        return Step(captured_ns, dt_s, samples, fresh.astype(np.bool_), jerk, driven, led)
