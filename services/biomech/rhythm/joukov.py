"""The canonical dynamical system of the Rhythmic EKF, literally (Joukov et al., eq. 15-21): the baseline.

    yhat     = sum_i alpha_i cos(i W) + beta_i sin(i W)        (17)   i = 1..n, rad/s
    e        = y - yhat
    dW/dt    = lambda - zeta e sin W                           (18)
    dlambda  = -zeta e sin W        per second                 (19)
    dalpha_i = eta cos(i W) e       per second                 (20)
    dbeta_i  = eta sin(i W) e       per second                 (21)
    F(W)     = -sum_i (i lambda)^2 (alpha_i cos(i W) + beta_i sin(i W))   second derivative of (17): the jerk of (15)

What the paper leaves open, and how it is read here:
- The rates zeta and eta could be per sample or per second. Per second: the other reading ends at a wrong frequency.
- The error that drives W and lambda: the paper takes phase and frequency from the right knee; `driver` says which
  channel. Each channel has its own e for its own coefficients.
- W appears in (18) as "lambda minus feedback", in (16) without: (18) is used. Integration is explicit Euler.
- The velocity fed in is whatever the caller passes, in the paper the filter's own estimate.
- zeta e is rad/s per rad/s: behaviour depends on the amplitude of the joint. That is kept.
- Nothing in the paper bounds lambda or says when the model holds. |lambda| is bounded far outside walking, and the
  reading always claims a lock, because the published method always believes itself.
"""

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from services.biomech.rhythm.compiled import compiled
from services.biomech.rhythm.memory import FloatArray
from services.biomech.rhythm.parameters import JoukovParameters
from services.biomech.rhythm.reading import RhythmReading
from services.flow.node import State, pack_array, unpack_array

PHASE, FREQUENCY, RESIDUAL_POWER, SIGNAL_POWER = range(4)
"""Slots of the oscillator: rad, rad/s, (rad/s)^2, (rad/s)^2."""


@compiled
def errors(velocity: FloatArray, series: FloatArray, phase: float, result: FloatArray) -> None:
    """e = y - yhat of each channel (17), rad/s. `series` (2, C, n): alpha and beta."""
    for c in range(velocity.size):
        expected = 0.0
        for i in range(series.shape[2]):
            angle = (i + 1) * phase
            expected += series[0, c, i] * cos(angle) + series[1, c, i] * sin(angle)
        result[c] = velocity[c] - expected


@compiled
def learn(series: FloatArray, error: FloatArray, phase: float, step: float) -> None:
    """(20) and (21) over one interval; step = eta dt."""
    for i in range(series.shape[2]):
        cosine, sine = cos((i + 1) * phase), sin((i + 1) * phase)
        for c in range(error.size):
            series[0, c, i] += step * cosine * error[c]
            series[1, c, i] += step * sine * error[c]


@compiled
def oscillate(oscillator: FloatArray, error: float, zeta: float, largest_frequency: float, dt_s: float) -> None:
    """(18) and (19) over one interval."""
    feedback = zeta * error * sin(oscillator[PHASE])
    oscillator[PHASE] += (oscillator[FREQUENCY] - feedback) * dt_s
    frequency = oscillator[FREQUENCY] - feedback * dt_s
    oscillator[FREQUENCY] = min(max(frequency, -largest_frequency), largest_frequency)


@compiled
def follow_powers(oscillator: FloatArray, velocity: FloatArray, error: FloatArray, gain: float) -> None:
    """Running means of e^2 and y^2 over all channels."""
    residual, signal = 0.0, 0.0
    for c in range(velocity.size):
        residual += error[c] * error[c] / velocity.size
        signal += velocity[c] * velocity[c] / velocity.size
    oscillator[RESIDUAL_POWER] += gain * (residual - oscillator[RESIDUAL_POWER])
    oscillator[SIGNAL_POWER] += gain * (signal - oscillator[SIGNAL_POWER])


@compiled
def differentiate_twice(series: FloatArray, phase: float, frequency: float, result: FloatArray) -> None:
    """F(W) of each channel, rad/s^3."""
    result[:] = 0.0
    for i in range(series.shape[2]):
        cosine, sine = cos((i + 1) * phase), sin((i + 1) * phase)
        for c in range(series.shape[1]):
            value = series[0, c, i] * cosine + series[1, c, i] * sine
            result[c] -= ((i + 1) * frequency) ** 2 * value


@compiled
def advance(
    oscillator: FloatArray,
    series: FloatArray,
    error: FloatArray,
    rates: FloatArray,
    driver: int,
    velocity: FloatArray,
    dt_s: float,
    reading: FloatArray,
) -> None:
    """One sample; rates are zeta, eta, largest frequency, quality time; reading gets phase, frequency, quality."""
    zeta, eta, largest_frequency, quality_time_s = rates
    phase = oscillator[PHASE]
    reading[0], reading[1] = phase, abs(oscillator[FREQUENCY])
    errors(velocity, series, phase, error)
    follow_powers(oscillator, velocity, error, min(dt_s / quality_time_s, 1.0))
    learn(series, error, phase, eta * dt_s)
    oscillate(oscillator, error[driver], zeta, largest_frequency, dt_s)
    quality = 1.0 - oscillator[RESIDUAL_POWER] / (oscillator[SIGNAL_POWER] + 1e-9)
    reading[2] = min(max(quality, 0.0), 1.0)


@compiled
def advance_many(
    oscillator: FloatArray,
    series: FloatArray,
    error: FloatArray,
    rates: FloatArray,
    driver: int,
    velocity: FloatArray,
    dt_s: float,
    readings: FloatArray,
) -> None:
    """`advance` over velocity (n, C); readings (n, 4): the last column, locked, is always 1."""
    for n in range(velocity.shape[0]):
        advance(oscillator, series, error, rates, driver, velocity[n], dt_s, readings[n])
        readings[n, 3] = 1.0


class JoukovOscillator:
    """The published oscillator (equations and readings at the head of this file).

    `phase` and `frequency` of a reading belong to the sample, `jerk` to the phase the next sample will have.
    `quality` is 1 - <e^2> / <y^2>, an addition that steers nothing.
    """

    def __init__(self, channels: int, parameters: JoukovParameters = JoukovParameters()) -> None:  # noqa: B008 (frozen)
        if not 0 <= parameters.driver < channels:
            raise ValueError(f"driver {parameters.driver} is none of the {channels} channels; choose 0..{channels - 1}")
        self.channels = channels
        self.parameters = parameters
        self._oscillator = np.array([0.0, parameters.initial_frequency, 0.0, 0.0])
        self._series = np.zeros((2, channels, parameters.harmonics))
        self._error = np.zeros(channels)
        self._rates = np.array(
            [
                parameters.frequency_rate,
                parameters.coefficient_rate,
                parameters.largest_frequency,
                parameters.quality_time_s,
            ]
        )

    def step(self, velocity: NDArray[np.float64], dt_s: float) -> RhythmReading:
        """Take one sample: rad/s, shape (channels,), dt_s after the sample before.

        Where a velocity is not a number the oscillator runs on without correction.
        """
        dt_s = max(dt_s, 0.0)
        reading = np.array([self._oscillator[PHASE], abs(self._oscillator[FREQUENCY]), 0.0])
        if np.isnan(velocity).any():
            self._oscillator[PHASE] += self._oscillator[FREQUENCY] * dt_s
        else:
            advance(*self._state(), self._bounded(velocity), dt_s, reading)
        jerk = np.zeros(self.channels)
        differentiate_twice(self._series, self._oscillator[PHASE], self._oscillator[FREQUENCY], jerk)
        phase, frequency, quality = reading.tolist()
        return RhythmReading(phase, frequency, quality, True, jerk)

    def run(self, velocity: NDArray[np.float64], dt_s: float) -> NDArray[np.float64]:
        """Take evenly spaced samples, rad/s, shape (n, channels); phase, frequency, quality, locked as (n, 4)."""
        readings = np.zeros((velocity.shape[0], 4))
        advance_many(*self._state(), self._bounded(velocity), dt_s, readings)
        return readings

    def _state(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, int]:
        return self._oscillator, self._series, self._error, self._rates, self.parameters.driver

    def _bounded(self, velocity: NDArray[np.float64]) -> NDArray[np.float64]:
        largest = self.parameters.largest_velocity
        return np.ascontiguousarray(np.minimum(np.maximum(velocity, -largest), largest))

    def snapshot(self) -> State:
        """Everything that changes, as JSON values."""
        return {"oscillator": pack_array(self._oscillator), "series": pack_array(self._series)}

    def restore(self, state: State) -> None:
        """Go on from a snapshot of an oscillator with the same channels and parameters."""
        series = unpack_array(state["series"])
        if series.shape != self._series.shape:
            raise ValueError(f"oscillator snapshot has series {series.shape}, this one needs {self._series.shape}")
        self._oscillator, self._series = unpack_array(state["oscillator"]), series
