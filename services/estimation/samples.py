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


class Sample(NamedTuple):
    """One usable sample of one sensor."""

    captured_ns: int
    sensor: int
    values: Values


@dataclass(frozen=True)
class Tick:
    """What the sensors said at one instant. Rows of `samples` (S, 6) count only where `fresh` (S,)."""

    captured_ns: int
    samples: Array
    fresh: NDArray[np.bool_]


@dataclass(frozen=True)
class TickBatch:
    """The ticks that one imu message completed. `captured_ns` is the message's; ticks may be none."""

    captured_ns: int
    ticks: tuple[Tick, ...]


def gather(samples: Iterable[Sample], sensors: int, same_tick_ns: int) -> tuple[Tick, ...]:
    """Samples in time order become ticks; a sensor that spoke twice starts a new one."""
    ticks: list[Tick] = []
    for sample in samples:
        last = ticks[-1] if ticks else None
        if last is None or sample.captured_ns - last.captured_ns > same_tick_ns or last.fresh[sample.sensor]:
            last = Tick(sample.captured_ns, np.zeros((sensors, 6)), np.zeros(sensors, dtype=np.bool_))
            ticks.append(last)
        last.samples[sample.sensor] = sample.values
        last.fresh[sample.sensor] = True
    return tuple(ticks)


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
