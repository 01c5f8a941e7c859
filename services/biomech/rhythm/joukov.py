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
    for c in range(error.size):
        for i in range(series.shape[2]):
            angle = (i + 1) * phase
            series[0, c, i] += step * cos(angle) * error[c]
            series[1, c, i] += step * sin(angle) * error[c]


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
    for c in range(series.shape[1]):
        result[c] = 0.0
        for i in range(series.shape[2]):
            angle = (i + 1) * phase
            value = series[0, c, i] * cos(angle) + series[1, c, i] * sin(angle)
            result[c] -= ((i + 1) * frequency) ** 2 * value


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

    def step(self, velocity: NDArray[np.float64], dt_s: float) -> RhythmReading:
        """Take one sample: rad/s, shape (channels,), dt_s after the sample before.

        Where a velocity is not a number the oscillator runs on without correction.
        """
        parameters, oscillator = self.parameters, self._oscillator
        phase, frequency = float(oscillator[PHASE]), float(oscillator[FREQUENCY])
        dt_s = max(dt_s, 0.0)
        if np.isnan(velocity).any():
            oscillator[PHASE] += frequency * dt_s
        else:
            bounded = np.clip(velocity, -parameters.largest_velocity, parameters.largest_velocity)
            errors(bounded, self._series, phase, self._error)
            follow_powers(oscillator, bounded, self._error, min(dt_s / parameters.quality_time_s, 1.0))
            learn(self._series, self._error, phase, parameters.coefficient_rate * dt_s)
            error = float(self._error[parameters.driver])
            oscillate(oscillator, error, parameters.frequency_rate, parameters.largest_frequency, dt_s)
        jerk = np.zeros(self.channels)
        differentiate_twice(self._series, oscillator[PHASE], oscillator[FREQUENCY], jerk)
        quality = 1.0 - oscillator[RESIDUAL_POWER] / (oscillator[SIGNAL_POWER] + 1e-9)
        return RhythmReading(phase, abs(frequency), min(max(float(quality), 0.0), 1.0), True, jerk)

    def snapshot(self) -> State:
        """Everything that changes, as JSON values."""
        return {"oscillator": pack_array(self._oscillator), "series": pack_array(self._series)}

    def restore(self, state: State) -> None:
        """Go on from a snapshot of an oscillator with the same channels and parameters."""
        series = unpack_array(state["series"])
        if series.shape != self._series.shape:
            raise ValueError(f"oscillator snapshot has series {series.shape}, this one needs {self._series.shape}")
        self._oscillator, self._series = unpack_array(state["oscillator"]), series
