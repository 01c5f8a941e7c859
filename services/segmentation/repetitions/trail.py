"""The angles since a movement began, and what a repetition is cut from them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]


class Sample(NamedTuple):
    """One movement at one time: rad, rad/s, rad; and the thigh's inclination forward, rad, 0 where it tells nothing."""

    captured_ns: int
    angle: float
    rate: float
    std: float
    thigh: float


class Course(NamedTuple):
    """A stretch of samples: time in s since its first one, then (n,) as in Sample; `smooth` is the averaged angle."""

    captured_ns: NDArray[np.int64]
    time_s: Array
    angle: Array
    rate: Array
    std: Array
    thigh: Array
    smooth: Array

    def at(self, captured_ns: int) -> int:
        """Index of the sample of a time, or of the first one after it."""
        return min(int(np.searchsorted(self.captured_ns, captured_ns)), len(self.captured_ns) - 1)


class Trail:
    """Samples in order of time."""

    def __init__(self) -> None:
        self._samples: list[Sample] = []

    @property
    def newest(self) -> Sample | None:
        """The last sample; None without any."""
        return self._samples[-1] if self._samples else None

    def append(self, sample: Sample) -> None:
        """Add the newest sample."""
        self._samples.append(sample)

    def clear(self) -> None:
        """Forget all."""
        self._samples.clear()

    def forget_before(self, captured_ns: int) -> None:
        """Drop what is older, half a second at a time so that little is moved about."""
        samples = self._samples
        if samples and captured_ns - samples[0].captured_ns > 500_000_000:
            first = next((i for i, sample in enumerate(samples) if sample.captured_ns >= captured_ns), len(samples))
            del samples[:first]

    def recent_mean(self, window_s: float) -> tuple[float, float]:
        """Mean angle and thigh inclination over the trailing window, rad."""
        newest_ns = self._samples[-1].captured_ns
        angle = thigh = 0.0
        count = 0
        for sample in reversed(self._samples):
            if newest_ns - sample.captured_ns >= window_s * 1e9:
                break
            angle += sample.angle
            thigh += sample.thigh
            count += 1
        return angle / count, thigh / count

    def course(self, window_s: float) -> Course:
        """All samples, with the angle averaged over a window to both sides."""
        ns = np.array([sample.captured_ns for sample in self._samples], dtype=np.int64)
        angle, rate, std, thigh = np.array([sample[1:] for sample in self._samples]).T
        half = round(window_s * 5e8)
        first = np.searchsorted(ns, ns - half, side="left")
        last = np.searchsorted(ns, ns + half, side="right")
        sums = np.concatenate([[0.0], np.cumsum(angle)])
        smooth = (sums[last] - sums[first]) / (last - first)
        return Course(ns, (ns - ns[0]) / 1e9, angle, rate, std, thigh, smooth)

    def snapshot(self) -> State:
        """Times and columns."""
        return {
            "captured_ns": [sample.captured_ns for sample in self._samples],
            "columns": pack_array(np.array([sample[1:] for sample in self._samples]).reshape(-1, 4)),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        rows = unpack_array(state["columns"]).tolist()
        self._samples = [Sample(ns, *row) for ns, row in zip(state["captured_ns"], rows, strict=True)]
