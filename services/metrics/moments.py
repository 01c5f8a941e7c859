"""Running mean and standard deviation."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]


@dataclass
class Moments:
    """Mean and sum of squared deviations of the values so far, updated one value at a time.

    For each value x: n <- n + 1, d = x - mean, mean <- mean + d / n, squares <- squares + d (x - mean).
    No cancellation, however large the mean is against the spread (Welford 1962).
    A value is a scalar () or a curve (101,).
    """

    count: int
    mean: Array
    squares: Array

    @classmethod
    def empty(cls, *shape: int) -> "Moments":
        """No values yet."""
        return cls(0, np.zeros(shape), np.zeros(shape))

    def add(self, value: Array | float) -> None:
        """Take one value."""
        self.count += 1
        deviation = value - self.mean
        self.mean = self.mean + deviation / self.count
        self.squares = self.squares + deviation * (value - self.mean)

    def merged(self, other: "Moments") -> "Moments":
        """The moments of both sets of values, neither of which changes (Chan 1979)."""
        count = self.count + other.count
        if count == 0:
            return replace(self)
        apart = other.mean - self.mean
        mean = self.mean + apart * (other.count / count)
        squares = self.squares + other.squares + apart * apart * (self.count * other.count / count)
        return Moments(count, mean, squares)

    def spread(self) -> Array | None:
        """Standard deviation with n - 1; None below two values."""
        return None if self.count < 2 else np.sqrt(self.squares / (self.count - 1))

    def snapshot(self) -> State:
        """Count and both arrays."""
        return {"count": self.count, "mean": pack_array(self.mean), "squares": pack_array(self.squares)}

    @classmethod
    def restored(cls, state: State) -> "Moments":
        """Inverse of `snapshot`."""
        return cls(state["count"], unpack_array(state["mean"]), unpack_array(state["squares"]))
