"""Quiet standing: gives every sensor its vertical and its gyroscope bias, and the body its zero.

One detector for all estimators. Stillness is judged over short blocks; a block counts once another still one has
followed, so that the start of a movement is not averaged in. An interval that the operator marked is taken as
standing from end to end. Sitting is told from standing where a thigh sensor can tell it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from schemas.session import SensorDescription, StandingInterval
from schemas.vocabulary import Segment
from services.estimation.parameters import StandingParameters
from services.estimation.samples import FORCE, RATE, Tick
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]

THIGHS = (Segment.THIGH_LEFT, Segment.THIGH_RIGHT)


@dataclass(frozen=True)
class StandingReference:
    """What standing told. Rows count where `usable` (S,)."""

    until_ns: int
    duration_s: float
    mean_force: Array  # (S, 3) m/s^2, sensor frame: points up
    gyro_bias: Array  # (S, 3) rad/s, sensor frame
    usable: NDArray[np.bool_]
    wrong_units: NDArray[np.bool_]  # (S,) gravity is not what it must be
    marked: bool = False  # by the operator, while the session ran


@dataclass
class Sums:
    """Count, sum and sum of squares of the samples of each sensor."""

    count: Array
    total: Array
    square: Array

    @classmethod
    def zero(cls, sensors: int) -> "Sums":
        """Nothing yet."""
        return cls(np.zeros(sensors), np.zeros((sensors, 6)), np.zeros((sensors, 6)))

    @classmethod
    def of(cls, ticks: Sequence[Tick]) -> "Sums":
        """Of one tick or more."""
        samples, fresh = np.array([tick.samples for tick in ticks]), np.array([tick.fresh for tick in ticks])
        heard = np.where(fresh[:, :, None], samples, 0.0)
        return cls(fresh.sum(axis=0).astype(np.float64), heard.sum(axis=0), (heard**2).sum(axis=0))

    def add_tick(self, tick: Tick) -> None:
        """Add the fresh samples of a tick."""
        self.count += tick.fresh
        self.total += tick.samples * tick.fresh[:, None]
        self.square += tick.samples**2 * tick.fresh[:, None]

    def add_ticks(self, samples: Array, fresh: NDArray[np.bool_]) -> None:
        """Add samples (n, S, 6) where fresh (n, S)."""
        counted = samples * fresh[:, :, None]
        self.count += fresh.sum(axis=0)
        self.total += counted.sum(axis=0)
        self.square += (samples * counted).sum(axis=0)

    def add(self, other: "Sums") -> None:
        """Add what another sum holds."""
        self.count += other.count
        self.total += other.total
        self.square += other.square

    def mean(self) -> Array:
        """(S, 6); zero where there is nothing."""
        return np.asarray(self.total / np.maximum(self.count, 1.0)[:, None])

    def std(self) -> Array:
        """(S, 6)."""
        variance = self.square / np.maximum(self.count, 1.0)[:, None] - self.mean() ** 2
        return np.asarray(np.sqrt(np.maximum(variance, 0.0)))

    def pack(self) -> State:
        """As one array."""
        return pack_array(np.concatenate([self.count[:, None], self.total, self.square], axis=1))

    @classmethod
    def unpack(cls, state: State) -> "Sums":
        """Inverse of `pack`."""
        table = unpack_array(state)
        return cls(table[:, 0].copy(), table[:, 1:7].copy(), table[:, 7:13].copy())


def is_still(block: Sums, limits: StandingParameters) -> bool:
    """Whether every sensor that spoke in a block was at rest; not where none did."""
    seen = block.count > 0
    rate = np.linalg.norm(block.mean()[:, RATE], axis=1)[seen]
    spread = np.linalg.norm(block.std()[:, FORCE], axis=1)[seen]
    return bool(seen.any() and (rate < limits.still_rate).all() and (spread < limits.still_force_std).all())


@dataclass
class StandingDetector:
    """Follows the ticks and keeps the newest standing that was long enough in `reference`.

    After `decide` the operator's word stands, and what looks like standing later changes nothing.
    """

    sensors: Sequence[SensorDescription]
    marked: Sequence[StandingInterval] = ()
    parameters: StandingParameters = field(default_factory=StandingParameters)
    reference: StandingReference | None = None
    is_still: bool = False
    is_sitting: bool = False
    is_decided: bool = False

    def __post_init__(self) -> None:
        self._block_start_ns: int | None = None
        self._span_start_ns: int | None = None
        self._newest_ns = 0
        self._block, self._held, self._span = (Sums.zero(len(self.sensors)) for _ in range(3))
        self._held_until_ns = 0

    @property
    def stood(self) -> float:
        """Share of the shortest standing that the present one has come to, 0 to 1; 1 once one was long enough."""
        if self.reference is not None:
            return 1.0
        if self._span_start_ns is None:
            return 0.0
        since_s = (self._newest_ns - self._span_start_ns) / 1e9
        # A block counts once another still one has followed.
        return min(1.0, since_s / (self.parameters.shortest_s + 2 * self.parameters.block_s))

    def decide(self, reference: StandingReference) -> None:
        """The operator has marked a standing."""
        self.reference, self.is_decided, self.is_sitting = reference, True, False
        self.marked = ()

    def withdraw(self) -> None:
        """What was taken for standing was sitting: wait for another one."""
        self.reference, self.is_decided, self.is_sitting = None, False, True

    def add(self, tick: Tick) -> None:
        """Take the next tick."""
        self._newest_ns = tick.captured_ns
        if self.marked:
            self._add_marked(tick)
            return
        if self._block_start_ns is None:
            self._block_start_ns = tick.captured_ns
        if tick.captured_ns - self._block_start_ns >= self.parameters.block_s * 1e9:
            self._close_block(tick.captured_ns)
        self._block.add_tick(tick)

    def _add_marked(self, tick: Tick) -> None:
        first = self.marked[0]
        if first.from_ns <= tick.captured_ns <= first.to_ns:
            self.is_still = True
            self._span.add_tick(tick)
        elif tick.captured_ns > first.to_ns and self.reference is None:
            self.is_still = False
            self.reference = refer(self._span, first.to_ns, (first.to_ns - first.from_ns) / 1e9, self.parameters)

    def _close_block(self, now_ns: int) -> None:
        assert self._block_start_ns is not None
        self.is_still = is_still(self._block, self.parameters)
        if not self.is_still:
            self._span_start_ns = None
            self._span, self._held = Sums.zero(len(self.sensors)), Sums.zero(len(self.sensors))
        elif self._span_start_ns is None:
            self._span_start_ns, self._held = self._block_start_ns, self._block
        else:
            self._span.add(self._held)
            self._held, self._held_until_ns = self._block, self._block_start_ns
            self._offer()
        self._block, self._block_start_ns = Sums.zero(len(self.sensors)), now_ns

    def _offer(self) -> None:
        assert self._span_start_ns is not None
        duration_s = (self._held_until_ns - self._span_start_ns) / 1e9
        if duration_s < self.parameters.shortest_s:
            return
        if self.is_decided:
            return
        candidate = refer(self._span, self._held_until_ns, duration_s, self.parameters)
        self.is_sitting = sits(candidate, self.sensors, self.parameters)
        if not self.is_sitting:
            self.reference = candidate

    def snapshot(self) -> State:
        """Everything but the description."""
        return {
            "reference": None if self.reference is None else pack_reference(self.reference),
            "flags": [self.is_still, self.is_sitting, self.is_decided],
            "times_ns": [self._block_start_ns, self._span_start_ns, self._newest_ns, self._held_until_ns],
            "sums": [sums.pack() for sums in (self._block, self._held, self._span)],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.reference = None if state["reference"] is None else unpack_reference(state["reference"])
        self.is_still, self.is_sitting, self.is_decided = state["flags"]
        self.marked = () if self.is_decided else self.marked
        self._block_start_ns, self._span_start_ns, self._newest_ns, self._held_until_ns = state["times_ns"]
        self._block, self._held, self._span = (Sums.unpack(packed) for packed in state["sums"])


def refer(sums: Sums, until_ns: int, duration_s: float, limits: StandingParameters) -> StandingReference:
    """What the samples of a standing tell: verticals, biases, sensors that cannot be used."""
    mean, seen = sums.mean(), sums.count > 0
    gravity = np.linalg.norm(mean[:, FORCE], axis=1)
    wrong = seen & (np.abs(gravity - limits.gravity) > limits.gravity_tolerance)
    bias = mean[:, RATE] * _trust_in_bias(duration_s, limits)
    return StandingReference(until_ns, duration_s, mean[:, FORCE], bias, seen & ~wrong, wrong)


def _trust_in_bias(duration_s: float, limits: StandingParameters) -> float:
    """Share of the mean rate that is bias: what sways by an angle a turns at a mean rate of a / duration.

    Least-squares mean of the prior (zero) and the measured rate: 0.99 after 10 s, 0.92 after 2 s, 0.74 after 1 s.
    A shorter standing, which only a description can mark, tells verticals alone.
    """
    if duration_s < limits.shortest_s:
        return 0.0
    return 1.0 / (1.0 + (limits.sway / (duration_s * limits.likely_bias)) ** 2)


def sits(reference: StandingReference, sensors: Sequence[SensorDescription], limits: StandingParameters) -> bool:
    """A thigh whose skin normal points up or down is not upright. A lateral sensor cannot tell."""
    for s, sensor in enumerate(sensors):
        if sensor.segment in THIGHS and reference.usable[s]:
            up = reference.mean_force[s] / np.linalg.norm(reference.mean_force[s])
            if abs(float(up @ np.array(sensor.outward_axis))) > limits.steepest_thigh:
                return True
    return False


def pack_reference(reference: StandingReference) -> State:
    """As JSON values, to the bit."""
    return {
        "until_ns": reference.until_ns,
        "duration_s": reference.duration_s,
        "means": pack_array(np.hstack([reference.mean_force, reference.gyro_bias])),
        "usable": [bool(flag) for flag in reference.usable],
        "wrong_units": [bool(flag) for flag in reference.wrong_units],
        "marked": reference.marked,
    }


def unpack_reference(state: State) -> StandingReference:
    """Inverse of `pack_reference`."""
    means = unpack_array(state["means"])
    return StandingReference(
        state["until_ns"],
        state["duration_s"],
        means[:, :3].copy(),
        means[:, 3:].copy(),
        np.array(state["usable"], dtype=np.bool_),
        np.array(state["wrong_units"], dtype=np.bool_),
        state["marked"],
    )
