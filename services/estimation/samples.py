"""Samples of all sensors brought onto one time line."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]
RATE = slice(0, 3)
"""Columns of a sample that hold the angular velocity, rad/s, sensor frame."""
FORCE = slice(3, 6)
"""Columns of a sample that hold the specific force, m/s^2, sensor frame."""


Values = tuple[float, ...]
"""Angular velocity, then specific force: six numbers."""
SILENT: Values = (0.0,) * 6
"""Fills the row of a sensor that has no sample in a tick."""


class Sample(NamedTuple):
    """One usable sample of one sensor."""

    captured_ns: int
    sensor: int
    values: Values


class Tick(NamedTuple):
    """What the sensors said at one instant. Rows of `samples` (S, 6) count only where `fresh` (S,)."""

    captured_ns: int
    samples: Array
    fresh: NDArray[np.bool_]

    def first(self, count: int) -> "Tick":
        """The same of the first sensors only."""
        if count == len(self.fresh):
            return self
        return Tick(self.captured_ns, self.samples[:count], self.fresh[:count])


@dataclass(frozen=True)
class TickBatch:
    """The ticks that one imu message completed. `captured_ns` is the message's; ticks may be none."""

    captured_ns: int
    ticks: tuple[Tick, ...]


def gather(samples: Iterable[Sample], sensors: int, same_tick_ns: int) -> tuple[Tick, ...]:
    """Samples in time order become ticks; a sensor that spoke twice starts a new one."""
    groups: list[tuple[int, dict[int, Values]]] = []
    for captured_ns, sensor, values in samples:
        if not groups or captured_ns - groups[-1][0] > same_tick_ns or sensor in groups[-1][1]:
            groups.append((captured_ns, {}))
        groups[-1][1][sensor] = values
    return tuple(_tick(captured_ns, spoken, sensors) for captured_ns, spoken in groups)


def _tick(captured_ns: int, spoken: dict[int, Values], sensors: int) -> Tick:
    rows = [spoken.get(sensor, SILENT) for sensor in range(sensors)]
    fresh = [sensor in spoken for sensor in range(sensors)]
    return Tick(captured_ns, np.array(rows, dtype=np.float64), np.array(fresh, dtype=np.bool_))


def pack_batches(batches: Iterable[TickBatch]) -> State:
    """Batches as JSON values, to the bit."""
    kept = list(batches)
    ticks = [tick for batch in kept for tick in batch.ticks]
    return {
        "captured_ns": [batch.captured_ns for batch in kept],
        "lengths": [len(batch.ticks) for batch in kept],
        "ticks_ns": [tick.captured_ns for tick in ticks],
        "samples": pack_array(np.array([tick.samples for tick in ticks])),
        "fresh": [int(flag) for tick in ticks for flag in tick.fresh],
    }


def unpack_batches(state: State, sensors: int) -> list[TickBatch]:
    """Inverse of `pack_batches`."""
    samples = unpack_array(state["samples"]).reshape(-1, sensors, 6)
    fresh = np.array(state["fresh"], dtype=np.bool_).reshape(-1, sensors)
    ticks = [Tick(*parts) for parts in zip(state["ticks_ns"], samples, fresh, strict=True)]
    batches, start = [], 0
    for captured_ns, length in zip(state["captured_ns"], state["lengths"], strict=True):
        batches.append(TickBatch(captured_ns, tuple(ticks[start : start + length])))
        start += length
    return batches
