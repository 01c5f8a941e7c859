"""What a rhythm has learned of a walk: the mean stride as a Fourier series of joint angles, with its spread.

Over each whole stride of the phase W the coefficients of velocity are a_k = 1/pi integral of v cos kW dW and b_k with
sin. With l the stride's own frequency, v = dq/dt and W = l t, so q = sum_k (a_k sin kW - b_k cos kW) / (k l): angles,
which a person repeats at another speed far better than velocities. Means and spreads are taken over these.
"""

from collections.abc import Sequence
from math import floor, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.rhythm.reading import RhythmReading
from services.flow.node import State, pack_array, unpack_array

HARMONICS = 10
LEAST_QUALITY = 0.6
"""Lock quality that every sample of a stride needs for the stride to count."""

FloatArray = NDArray[np.float64]


class Learned(NamedTuple):
    """Mean stride of C joints. The angle about its mean: q_c(W) = sum_k cosine[c, k-1] cos kW + sine[c, k-1] sin kW."""

    strides: int
    frequency: float
    """rad/s."""
    frequency_spread: float
    """rad/s, standard deviation over the strides; 0 for a single one."""
    quality: float
    """Mean over the strides of their lowest lock quality."""
    cosine: FloatArray
    """rad, shape (C, N)."""
    sine: FloatArray
    """rad, shape (C, N)."""
    spread: FloatArray
    """rad, shape (C, N): standard deviation over the strides, root mean square of the cosine's and the sine's."""


class Stride(NamedTuple):
    """One whole stride."""

    frequency: float
    """rad/s."""
    quality: float
    """The lowest of its samples."""
    angles: FloatArray
    """rad, shape (2, C, N): cosine and sine coefficients."""


class LearnedStrides:
    """Mean and spread of the strides in lock, over all bouts of a session: the phase reference survives stops.

    A stride counts when the lock held throughout, its quality was good and the next stride is complete too; so the
    last one before a stop, which is half a stop itself, never does.
    """

    def __init__(self, channels: int, harmonics: int = HARMONICS) -> None:
        self._channels, self._harmonics = channels, harmonics
        self._samples: list[list[float]] = []
        """Of the stride under way: phase, quality, s since the sample before, velocities."""
        self._before: list[float] | None = None
        self._pending: Stride | None = None
        self.strides = 0
        """How many have counted."""
        self._mean = np.zeros(2 + 2 * channels * harmonics)
        self._squares = np.zeros_like(self._mean)

    def take(self, velocity: Sequence[float], reading: RhythmReading, dt_s: float) -> None:
        """Take one sample: rad/s, one per channel, dt_s after the one before, and what the rhythm made of it."""
        sample = [reading.phase, reading.quality, dt_s, *velocity]
        before = self._before
        if not reading.locked or before is None or not 0.0 < sample[0] - before[0] < 1.0:
            self.interrupt()
            self._before = sample
            return
        self._before = sample
        boundary = 2.0 * pi * floor(sample[0] / (2.0 * pi))
        if before[0] >= boundary:
            if self._samples:
                self._samples.append(sample)
            return
        crossing, rest = _split(before, sample, boundary)
        if self._samples:
            self._close([*self._samples, crossing])
        self._samples = [[boundary, sample[1], 0.0, *crossing[3:]], rest]

    def interrupt(self) -> None:
        """The stride under way, and the one before it, do not count."""
        self._samples = []
        self._before = self._pending = None

    def _close(self, samples: list[list[float]]) -> None:
        if self._pending is not None:
            self._count(self._pending)
        stride = _analysed(np.array(samples), self._harmonics)
        self._pending = stride if stride.quality >= LEAST_QUALITY else None

    def _count(self, stride: Stride) -> None:
        """Welford's update of mean and squared deviations."""
        values = np.concatenate([[stride.frequency, stride.quality], stride.angles.ravel()])
        self.strides += 1
        apart = values - self._mean
        self._mean += apart / self.strides
        self._squares += apart * (values - self._mean)

    def result(self) -> Learned:
        """The mean stride so far. Zeros before the first one."""
        shape = (2, self._channels, self._harmonics)
        variance = self._squares / max(self.strides - 1, 1)
        cosine, sine = self._mean[2:].reshape(shape).copy()
        return Learned(
            strides=self.strides,
            frequency=float(self._mean[0]),
            frequency_spread=float(np.sqrt(variance[0])),
            quality=float(self._mean[1]),
            cosine=cosine,
            sine=sine,
            spread=np.sqrt(variance[2:].reshape(shape).mean(axis=0)),
        )

    def snapshot(self) -> State:
        """Everything that changes, as JSON values."""
        pending = self._pending
        return {
            "samples": self._samples,
            "before": self._before,
            "pending": None if pending is None else [pending.frequency, pending.quality, pack_array(pending.angles)],
            "strides": self.strides,
            "mean": pack_array(self._mean),
            "squares": pack_array(self._squares),
        }

    def restore(self, state: State) -> None:
        """Go on from a snapshot of the same number of channels and harmonics."""
        self._samples = [list(sample) for sample in state["samples"]]
        self._before = state["before"]
        self._pending = None
        if state["pending"] is not None:
            frequency, quality, angles = state["pending"]
            self._pending = Stride(frequency, quality, unpack_array(angles))
        self.strides = state["strides"]
        self._mean = unpack_array(state["mean"])
        self._squares = unpack_array(state["squares"])


def _split(before: list[float], sample: list[float], boundary: float) -> tuple[list[float], list[float]]:
    """The sample that would lie on the boundary (rad), by linear interpolation, and what is left of `sample`."""
    share = (boundary - before[0]) / (sample[0] - before[0])
    velocity = [a + share * (b - a) for a, b in zip(before[3:], sample[3:], strict=True)]
    crossing = [boundary, sample[1], share * sample[2], *velocity]
    return crossing, [sample[0], sample[1], (1.0 - share) * sample[2], *sample[3:]]


def _analysed(samples: FloatArray, harmonics: int) -> Stride:
    """Fourier coefficients of a stride, by the trapezium rule over phase; rows as in `LearnedStrides._samples`."""
    phase, velocity = samples[:, 0], samples[:, 3:]
    order = np.arange(1, harmonics + 1)
    steps = np.diff(phase)
    weight = 0.5 * (np.append(steps, 0.0) + np.append(0.0, steps)) / pi
    turned = np.exp(1j * np.outer(phase, order)) * weight[:, None]
    coefficients = velocity.T @ turned
    frequency = 2.0 * pi / float(samples[:, 2].sum())
    scale = order * frequency
    angles = np.stack([-coefficients.imag / scale, coefficients.real / scale])
    return Stride(frequency, float(samples[:, 1].min()), angles)


def velocity_waveform(cosine: FloatArray, sine: FloatArray, frequency: float) -> FloatArray:
    """Coefficients (2, C, N) of velocity, rad/s, of angles (C, N), rad, walked at a frequency (rad/s).

    dq/dt = sum_k k l (sine_k cos kW - cosine_k sin kW).
    """
    order = np.arange(1, cosine.shape[1] + 1) * frequency
    return np.stack([order * sine, -order * cosine])
