"""What channels of a walk do over a stride: means on a grid of the rhythm's phase, and how far strides differ.

The waveform of the rhythm serves to find the phase: velocities of the joints that share the stride, as harmonics.
This one serves to go on without a sensor: any channels, with their means, right after the first stride. Each channel
has two values (such as an angle and its rate), that are heard together or not at all. Between two points of the grid
values are interpolated.
"""

from math import floor, pi, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.rhythm.compiled import compiled
from services.biomech.rhythm.memory import FloatArray
from services.flow.node import State, pack_array, unpack_array

POINTS = 48
"""Grid points of a stride. A knee bends by up to 7 deg from one to the next; a line between them is right to 0.2."""
LEAST_WEIGHT = 0.3
"""Samples near a grid point, from which on it has a mean."""


class Expected(NamedTuple):
    """The channels at one phase. `known` (n,): strides were seen; elsewhere the rest means nothing."""

    value: FloatArray  # (2, n)
    std: FloatArray  # (2, n) deviation of a stride from the mean of those before it
    known: NDArray[np.bool_]


class Shape(NamedTuple):
    """What was learned of n channels."""

    mean: FloatArray  # (2, POINTS, n)
    weight: FloatArray  # (POINTS, n) samples at a grid point
    variance: FloatArray  # (2, n) of strides about the mean before them
    turned: FloatArray  # (n,) strides over which the variance was taken


class StrideShape:
    """Mean over the last strides of n channels, newer strides weigh more."""

    def __init__(self, floor: FloatArray, strides: float) -> None:
        """`floor` (2, n): standard deviations below which a difference is no surprise; `strides` of the mean."""
        channels = floor.shape[1]
        self._floor, self._strides = floor, strides
        self._shape = Shape(
            np.zeros((2, POINTS, channels)),
            np.zeros((POINTS, channels)),
            np.zeros((2, channels)),
            np.zeros(channels),
        )
        self._expected = Expected(np.zeros((2, channels)), np.zeros((2, channels)), np.zeros(channels, dtype=np.bool_))
        self.surprise = np.zeros((2, channels))
        """Squared difference of the last values from what was expected, in variances; 0 where nothing was."""

    def learn(self, phase: float, turned: float, values: FloatArray, heard: NDArray[np.bool_]) -> None:
        """Take values (2, n) at a phase (rad), `turned` strides after those before; only channels `heard` (n,)."""
        _learn(self._shape, self._floor, self._strides, phase, turned, values, heard, self.surprise)

    def expect(self, phase: float) -> Expected:
        """The channels at a phase (rad). The arrays are overwritten by the next call."""
        _expect(self._shape, phase, self._expected)
        return self._expected

    def snapshot(self) -> State:
        """Everything that was learned."""
        return {name: pack_array(array) for name, array in self._shape._asdict().items()}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`, for a shape of as many channels."""
        for name, array in self._shape._asdict().items():
            array[...] = unpack_array(state[name])


@compiled
def place(phase: float) -> tuple[int, int, float]:
    """The two grid points around a phase, and the share of the second."""
    turns = phase / (2.0 * pi)
    at = (turns - floor(turns)) * POINTS
    first = min(int(at), POINTS - 1)
    return first, (first + 1) % POINTS, at - first


@compiled
def _learn(
    shape: Shape,
    least_std: FloatArray,
    strides: float,
    phase: float,
    turned: float,
    values: FloatArray,
    heard: NDArray[np.bool_],
    surprise: FloatArray,
) -> None:
    before, after, share = place(phase)
    surprise[:] = 0.0
    most_weight = strides / (turned * POINTS + 1e-9)
    for j in range(values.shape[1]):
        if not heard[j]:
            continue
        if min(shape.weight[before, j], shape.weight[after, j]) > LEAST_WEIGHT:
            judge(shape, least_std, strides, before, after, share, turned, values, j, surprise)
        for point, part in ((before, 1.0 - share), (after, share)):
            shape.weight[point, j] += part
            gain = part / max(min(shape.weight[point, j], most_weight), part + 1e-9)
            for order in range(2):
                shape.mean[order, point, j] += gain * (values[order, j] - shape.mean[order, point, j])


@compiled
def judge(
    shape: Shape,
    least_std: FloatArray,
    strides: float,
    before: int,
    after: int,
    share: float,
    turned: float,
    values: FloatArray,
    j: int,
    surprise: FloatArray,
) -> None:
    """Compare a channel with its mean: how surprising that is, and how far strides differ."""
    shape.turned[j] += turned
    gain = turned / max(min(shape.turned[j], strides), turned)
    for order in range(2):
        error = values[order, j] - (1.0 - share) * shape.mean[order, before, j] - share * shape.mean[order, after, j]
        if shape.turned[j] > 1.0:
            surprise[order, j] = error**2 / (shape.variance[order, j] + least_std[order, j] ** 2)
        shape.variance[order, j] += gain * (error**2 - shape.variance[order, j])


@compiled
def _expect(shape: Shape, phase: float, expected: Expected) -> None:
    before, after, share = place(phase)
    for j in range(shape.turned.size):
        seen = min(shape.weight[before, j], shape.weight[after, j])
        expected.known[j] = shape.turned[j] >= 1.0 and seen > LEAST_WEIGHT
        for order in range(2):
            mean = (1.0 - share) * shape.mean[order, before, j] + share * shape.mean[order, after, j]
            expected.value[order, j] = mean
            expected.std[order, j] = sqrt(shape.variance[order, j])
