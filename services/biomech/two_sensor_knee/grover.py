"""The knee band as published: Grover and Natarajan, eq. 6-24, planar, sensors aligned with the leg.

The paper's eq. 14 adds the knee's rate to the thigh's to get the shank's, while eq. 22 subtracts the shank's
inclination from the thigh's; with equally mounted sensors these have opposite signs. The rates are followed here:
knee = shank - thigh, positive counterclockwise as the gyroscopes. Units are not given for Q and R; rad are taken.
"""

from dataclasses import dataclass
from math import atan2, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.flow.node import State


@dataclass(frozen=True)
class GroverParameters:
    """The paper's constants."""

    rate_hz: float = 20.0
    start_variance: float = 1000.0
    """P0, eq. 12."""
    angle_noise: float = 1e-4
    """rad^2 a step, eq. 13."""
    bias_noise: float = 1e-6
    """(rad/s)^2 a step, eq. 13."""
    tilt_noise: float = 1e-3
    """rad^2, R."""
    debias_samples: int = 1000
    """Samples before the simplified filter starts."""


class PlanarSample(NamedTuple):
    """Both sensors in the sagittal plane: rates about the flexion axis (rad/s), inclinations by gravity (rad)."""

    thigh_rate: float
    thigh_tilt: float
    shank_rate: float
    shank_tilt: float


def tilt(normal: float, tangential: float) -> float:
    """Inclination, rad, of a sensor at rest (eq. 6): atan(a_y / a_z), over the whole circle."""
    return atan2(normal, tangential)


def wrapped(angle: float) -> float:
    """`angle` within [-pi, pi)."""
    return (angle + pi) % (2.0 * pi) - pi


class AngleBiasFilter:
    """Two states, angle and gyroscope bias: eq. 9-13 for the thigh, eq. 18-20 for the knee."""

    def __init__(self, parameters: GroverParameters) -> None:
        self.angle, self.bias = 0.0, 0.0
        self._p00, self._p01, self._p11 = parameters.start_variance, 0.0, parameters.start_variance
        self._noise = parameters

    def step(self, rate: float, measured: float, dt_s: float) -> float:
        """Predict with the measured rate, correct with the measured angle; the angle, rad."""
        noise = self._noise
        # x = [1 -dt; 0 1] x + [dt; 0] rate, P = A P A' + Q
        angle = self.angle + (rate - self.bias) * dt_s
        p00 = self._p00 - 2.0 * dt_s * self._p01 + dt_s * dt_s * self._p11 + noise.angle_noise
        p01 = self._p01 - dt_s * self._p11
        p11 = self._p11 + noise.bias_noise
        # H = [1 0]
        innovation = measured - angle
        if abs(innovation) > pi:
            innovation = wrapped(innovation)
        gain_angle, gain_bias = p00 / (p00 + noise.tilt_noise), p01 / (p00 + noise.tilt_noise)
        self.angle = angle = angle + gain_angle * innovation
        self.bias += gain_bias * innovation
        self._p00, self._p01, self._p11 = (1.0 - gain_angle) * p00, (1.0 - gain_angle) * p01, p11 - gain_bias * p01
        return angle

    def snapshot(self) -> list[float]:
        """Everything that changes."""
        return [self.angle, self.bias, self._p00, self._p01, self._p11]

    def restore(self, state: list[float]) -> None:
        """Go on from a snapshot."""
        self.angle, self.bias, self._p00, self._p01, self._p11 = state


class AngleFilter:
    """One state, the angle: eq. 23 for the thigh, eq. 24 for the knee."""

    def __init__(self, parameters: GroverParameters) -> None:
        self.angle = 0.0
        self._p = parameters.start_variance
        self._angle_noise, self._tilt_noise = parameters.angle_noise, parameters.tilt_noise

    def step(self, rate: float, measured: float, dt_s: float) -> float:
        """Predict with the de-biased rate, correct with the measured angle; the angle, rad."""
        angle = self.angle + rate * dt_s
        p = self._p + self._angle_noise
        gain = p / (p + self._tilt_noise)
        innovation = measured - angle
        if abs(innovation) > pi:
            innovation = wrapped(innovation)
        self.angle = angle = angle + gain * innovation
        self._p = (1.0 - gain) * p
        return angle

    def snapshot(self) -> list[float]:
        """Everything that changes."""
        return [self.angle, self._p]

    def restore(self, state: list[float]) -> None:
        """Go on from a snapshot."""
        self.angle, self._p = state


class ConventionalKnee:
    """Thigh and knee filters with a bias state each (section 3.2.1)."""

    def __init__(self, parameters: GroverParameters = GroverParameters()) -> None:
        self.thigh, self.knee = AngleBiasFilter(parameters), AngleBiasFilter(parameters)

    def step(self, sample: PlanarSample, dt_s: float) -> float:
        """The knee's angle, rad. The thigh's bias enters the knee's rate (eq. 17)."""
        thigh_rate, thigh_tilt, shank_rate, shank_tilt = sample
        self.thigh.step(thigh_rate, thigh_tilt, dt_s)
        return self.knee.step(shank_rate - thigh_rate + self.thigh.bias, shank_tilt - thigh_tilt, dt_s)

    def snapshot(self) -> State:
        """Everything that changes, as JSON values."""
        return {"thigh": self.thigh.snapshot(), "knee": self.knee.snapshot()}

    def restore(self, state: State) -> None:
        """Go on from a snapshot."""
        self.thigh.restore(state["thigh"])
        self.knee.restore(state["knee"])


class SimplifiedKnee:
    """One-state filters on gyroscopes freed of the mean of their first samples (section 3.2.2)."""

    def __init__(self, parameters: GroverParameters = GroverParameters()) -> None:
        self.thigh, self.knee = AngleFilter(parameters), AngleFilter(parameters)
        self.thigh_bias, self.shank_bias = 0.0, 0.0
        self._wanted = parameters.debias_samples
        self._first: list[tuple[float, float]] | None = []

    def step(self, sample: PlanarSample, dt_s: float) -> float | None:
        """The knee's angle, rad; None while the biases are still being learned."""
        thigh_rate, thigh_tilt, shank_rate, shank_tilt = sample
        if self._first is not None:
            self._learn(self._first, thigh_rate, shank_rate)
            return None
        thigh_rate -= self.thigh_bias
        self.thigh.step(thigh_rate, thigh_tilt, dt_s)
        return self.knee.step(shank_rate - self.shank_bias - thigh_rate, shank_tilt - thigh_tilt, dt_s)

    def snapshot(self) -> State:
        """Everything that changes, as JSON values."""
        first = None if self._first is None else [list(pair) for pair in self._first]
        return {
            "thigh": self.thigh.snapshot(), "knee": self.knee.snapshot(),
            "biases": [self.thigh_bias, self.shank_bias], "first": first,
        }  # fmt: skip

    def restore(self, state: State) -> None:
        """Go on from a snapshot of a knee that learns from as many samples."""
        self.thigh.restore(state["thigh"])
        self.knee.restore(state["knee"])
        self.thigh_bias, self.shank_bias = state["biases"]
        self._first = None if state["first"] is None else [(thigh, shank) for thigh, shank in state["first"]]

    def _learn(self, first: list[tuple[float, float]], thigh_rate: float, shank_rate: float) -> None:
        first.append((thigh_rate, shank_rate))
        if len(first) >= self._wanted:
            self.thigh_bias, self.shank_bias = constant_part(np.array(first)).tolist()
            self._first = None


def constant_part(signal: NDArray[np.float64]) -> NDArray[np.float64]:
    """Zero-frequency term of the Fourier transform over the samples, signal (n,) or (n, k), as a mean (figure 4)."""
    return np.asarray(np.fft.rfft(signal, axis=0)[0].real / len(signal))


def bias_by_window(signal: NDArray[np.float64], windows: NDArray[np.int64]) -> NDArray[np.float64]:
    """The bias that `constant_part` gives for the first n samples, for each n in `windows` (figure 5)."""
    return np.array([constant_part(signal[:n]) for n in windows])
