"""What both published filters cost: run time in one compiled form, operations, memory (table 1).

`services.biomech.two_sensor_knee.grover` holds the filters; here their steps are written out once more without
objects, so that one compiler sees both alike and no interpreter is measured. A test holds both forms together.
"""

import time
from collections import Counter
from collections.abc import Callable, Sequence
from math import pi
from typing import Any, ClassVar, NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from services.biomech.two_sensor_knee.grover import (
    ConventionalKnee,
    GroverParameters,
    PlanarSample,
    SimplifiedKnee,
    constant_part,
)

Array = NDArray[np.float64]
Two = tuple[float, float]
Five = tuple[float, float, float, float, float]

TWO_STATES, ONE_STATE = 5, 2
"""Numbers that one filter keeps: angle, bias and three of the covariance; angle and variance."""
REPEATS = 60
ROUNDS = 10
"""Times that the recording is played in one measurement."""
SESSION_S = 600.0
"""s of use over which the learning of the biases is spread."""

_compiled: Callable[[Any], Any] = numba.njit(cache=True, error_model="numpy", nogil=True)


class Noise(NamedTuple):
    """Constants of one step, as compiled code takes them."""

    angle: float
    bias: float
    tilt: float
    dt_s: float


class Cost(NamedTuple):
    """s of processor time for one sample of one knee, both filters of it; medians over interleaved repetitions."""

    conventional_s: float
    simplified_s: float
    ratio: float
    learning_s: float  # once, the Fourier transform of both gyroscopes' first samples


@_compiled
def wrap(angle: float) -> float:
    """Nearer to zero by a turn where beyond half a turn; without a branch."""
    return angle - (2.0 * pi if angle > pi else 0.0) + (2.0 * pi if angle < -pi else 0.0)


@_compiled
def two_states(x: Five, rate: float, measured: float, noise: Noise) -> Five:
    """One step of angle, bias, p00, p01, p11 (eq. 9-13 for the thigh, 18-20 for the knee)."""
    angle, bias, p00, p01, p11 = x
    angle += (rate - bias) * noise.dt_s
    p00 += noise.angle - noise.dt_s * (2.0 * p01 - noise.dt_s * p11)
    p01 -= noise.dt_s * p11
    p11 += noise.bias
    innovation = wrap(measured - angle)
    share = 1.0 / (p00 + noise.tilt)
    gain_angle, gain_bias = p00 * share, p01 * share
    left = 1.0 - gain_angle
    return angle + gain_angle * innovation, bias + gain_bias * innovation, left * p00, left * p01, p11 - gain_bias * p01


@_compiled
def one_state(x: Two, rate: float, measured: float, noise: Noise) -> Two:
    """One step of angle and variance (eq. 23, 24)."""
    angle, p = x[0] + rate * noise.dt_s, x[1] + noise.angle
    gain = p / (p + noise.tilt)
    return angle + gain * wrap(measured - angle), (1.0 - gain) * p


@_compiled
def run_conventional(samples: Array, start_variance: float, noise: Noise, out: Array) -> None:
    """Knee angles (n,) of one leg from samples (n, 4) as `PlanarSample`."""
    thigh = knee = (0.0, 0.0, start_variance, 0.0, start_variance)
    for k in range(samples.shape[0]):
        rate, tilt = samples[k, 0], samples[k, 1]
        thigh = two_states(thigh, rate, tilt, noise)
        knee = two_states(knee, samples[k, 2] - rate + thigh[1], samples[k, 3] - tilt, noise)
        out[k] = knee[0]


@_compiled
def run_simplified(samples: Array, biases: Array, start_variance: float, noise: Noise, out: Array) -> None:
    """The same with the one-state filters; biases (2,) are known."""
    thigh = knee = (0.0, start_variance)
    for k in range(samples.shape[0]):
        rate, tilt = samples[k, 0] - biases[0], samples[k, 1]
        thigh = one_state(thigh, rate, tilt, noise)
        knee = one_state(knee, samples[k, 2] - biases[1] - rate, samples[k, 3] - tilt, noise)
        out[k] = knee[0]


@_compiled
def run_conventional_legs(samples: Array, start_variance: float, noise: Noise, out: Array) -> None:
    """Knee angles (n, legs) of legs side by side that all see the same samples."""
    x = np.zeros((10, out.shape[1]))
    x[2], x[4], x[7], x[9] = start_variance, start_variance, start_variance, start_variance
    for k in range(samples.shape[0]):
        rate, tilt = samples[k, 0], samples[k, 1]
        knee_rate, knee_tilt = samples[k, 2] - rate, samples[k, 3] - tilt
        for leg in range(out.shape[1]):
            thigh = two_states((x[0, leg], x[1, leg], x[2, leg], x[3, leg], x[4, leg]), rate, tilt, noise)
            before = (x[5, leg], x[6, leg], x[7, leg], x[8, leg], x[9, leg])
            knee = two_states(before, knee_rate + thigh[1], knee_tilt, noise)
            x[0, leg], x[1, leg], x[2, leg], x[3, leg], x[4, leg] = thigh
            x[5, leg], x[6, leg], x[7, leg], x[8, leg], x[9, leg] = knee
            out[k, leg] = knee[0]


@_compiled
def run_simplified_legs(samples: Array, biases: Array, start_variance: float, noise: Noise, out: Array) -> None:
    """The same with the one-state filters."""
    x = np.zeros((4, out.shape[1]))
    x[1], x[3] = start_variance, start_variance
    for k in range(samples.shape[0]):
        rate, tilt = samples[k, 0] - biases[0], samples[k, 1]
        knee_rate, knee_tilt = samples[k, 2] - biases[1] - rate, samples[k, 3] - tilt
        for leg in range(out.shape[1]):
            thigh = one_state((x[0, leg], x[1, leg]), rate, tilt, noise)
            knee = one_state((x[2, leg], x[3, leg]), knee_rate, knee_tilt, noise)
            x[0, leg], x[1, leg] = thigh
            x[2, leg], x[3, leg] = knee
            out[k, leg] = knee[0]


def noise_of(parameters: GroverParameters) -> Noise:
    """The paper's constants."""
    return Noise(parameters.angle_noise, parameters.bias_noise, parameters.tilt_noise, 1.0 / parameters.rate_hz)


def compiled_cost(samples: Sequence[PlanarSample], legs: int, parameters: GroverParameters) -> Cost:
    """Both filters in turn on the same samples for so many legs side by side.

    One leg waits for each sample's division before it can begin the next: that is latency. Many legs side by side
    keep the processor busy: that is work.
    """
    once = np.array(samples, dtype=np.float64)
    played = np.ascontiguousarray(np.tile(once, (max(1, ROUNDS // legs), 1)))
    first = np.ascontiguousarray(once[: parameters.debias_samples, [0, 2]])
    biases, start, noise = constant_part(first), parameters.start_variance, noise_of(parameters)
    out = np.empty((len(played), legs)) if legs > 1 else np.empty(len(played))
    two, one = (run_conventional_legs, run_simplified_legs) if legs > 1 else (run_conventional, run_simplified)

    def conventional() -> None:
        two(played, start, noise, out)

    def simplified() -> None:
        one(played, biases, start, noise, out)

    def learn() -> None:
        constant_part(first)

    timed = [(_seconds(conventional), _seconds(simplified), _seconds(learn)) for _ in range(REPEATS)]
    spent = np.array(timed[1:])  # the first compiles
    two_s, one_s, learning_s = np.median(spent, axis=0).tolist()
    return Cost(two_s / out.size, one_s / out.size, float(np.median(spent[:, 0] / spent[:, 1])), learning_s)


def plain_cost(samples: Sequence[PlanarSample], parameters: GroverParameters, repeats: int = 15) -> Cost:
    """The filters of the library as an interpreter runs them, the simplified one after it has learned."""
    learned = SimplifiedKnee(parameters)
    for sample in samples[: parameters.debias_samples]:
        learned.step(sample, 1.0 / parameters.rate_hz)

    def play(step: Callable[[PlanarSample, float], float | None]) -> None:
        dt_s = 1.0 / parameters.rate_hz
        for sample in samples:
            step(sample, dt_s)

    pairs = [
        (_seconds(lambda: play(ConventionalKnee(parameters).step)), _seconds(lambda: play(learned.step)))
        for _ in range(repeats)
    ]
    spent = np.array(pairs)
    two_s, one_s = (np.median(spent, axis=0) / len(samples)).tolist()
    return Cost(two_s, one_s, float(np.median(spent[:, 0] / spent[:, 1])), 0.0)


def over_a_session(cost: Cost, parameters: GroverParameters) -> float:
    """Conventional over simplified for a session of SESSION_S, the learning of the biases paid for."""
    samples = SESSION_S * parameters.rate_hz
    running = samples - parameters.debias_samples
    return samples * cost.conventional_s / (running * cost.simplified_s + cost.learning_s)


def _seconds(work: Callable[[], None]) -> float:
    begin = time.thread_time()
    work()
    return time.thread_time() - begin


class Counted:
    """A number that counts what is done with it."""

    done: ClassVar[Counter[str]] = Counter()

    def __init__(self, value: float) -> None:
        self.value = value

    def _with(self, name: str, value: float) -> "Counted":
        Counted.done[name] += 1
        return Counted(value)

    def __add__(self, other: Any) -> "Counted":
        return self._with("add", self.value + float(other))

    def __sub__(self, other: Any) -> "Counted":
        return self._with("add", self.value - float(other))

    def __rsub__(self, other: Any) -> "Counted":
        return self._with("add", float(other) - self.value)

    def __mul__(self, other: Any) -> "Counted":
        return self._with("multiply", self.value * float(other))

    def __truediv__(self, other: Any) -> "Counted":
        return self._with("divide", self.value / float(other))

    def __abs__(self) -> "Counted":
        return Counted(abs(self.value))

    def __gt__(self, other: Any) -> bool:
        Counted.done["compare"] += 1
        return self.value > float(other)

    def __float__(self) -> float:
        return self.value

    __radd__, __rmul__ = __add__, __mul__


def operations(parameters: GroverParameters) -> dict[str, Counter[str]]:
    """Arithmetic of one sample of a knee, both filters of it, by counting numbers sent through the library's code."""
    counted = {}
    for name, knee in (("conventional", ConventionalKnee(parameters)), ("simplified", SimplifiedKnee(parameters))):
        sample = PlanarSample(0.1, 0.2, 0.3, 0.4)
        for _ in range(parameters.debias_samples):
            knee.step(sample, 0.05)
        for one in (knee.thigh, knee.knee):
            one.restore([Counted(value) for value in one.snapshot()])  # type: ignore[misc]
        Counted.done = Counter()
        knee.step(PlanarSample(*(Counted(value) for value in sample)), Counted(0.05))  # type: ignore[arg-type]
        counted[name] = Counted.done
    return counted
