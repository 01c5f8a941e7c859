"""Motions of one joint for the scoreboard of the Rhythmic EKF: the published simulation, and what people do besides.

All at 100 Hz, rad, with an IMU at 0.5 m and the published noise. Numbers come from the seed alone. Each motion is the
cubic spline through its velocities, so that angle, velocity, acceleration and jerk belong together exactly.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from services.bench.rhythm.motions import INTERVAL_S, gait_motion, random_motion
from services.bench.rhythm.stride_shapes import StrideShapes
from services.biomech.single_joint.ekf import GRAVITY, JointSensor

FloatArray = NDArray[np.float64]

SENSOR = JointSensor()
WEAKEST, STRONGEST = 0.5, 4.0
"""rad/s: RMS of the random motions, from slow walking to running."""
SWEEP_HARMONICS = 5
SLOWEST, FASTEST, RAMP_S = 1.0, 5.0, 40.0
"""rad/s, rad/s, s: the frequency sweep of the simulation."""
KNEE = 0
WALKING = 5.0  # rad/s


@dataclass(frozen=True)
class JointMotion:
    """One motion with its truth and the samples a noisy IMU gives."""

    state: FloatArray
    """Angle rad, velocity rad/s, acceleration rad/s^2, shape (n, 3)."""
    jerk: FloatArray
    """rad/s^3, shape (n,)."""
    samples: FloatArray
    """Gyro rad/s, radial and tangential specific force m/s^2 with noise, shape (n, 3)."""
    phase: FloatArray | None
    """rad, shape (n,); None where there is no period."""
    frequency: float
    """rad/s at the start, walking frequency where there is no period."""
    guess: float
    """rad/s, 15 % off: what the published estimator is told."""


def sweep(seed: int, hold_s: float = 0.0) -> JointMotion:
    """Section IV-A: five harmonics with random coefficients, frequency from 1 to 5 rad/s.

    The paper does not say whether the first 40 s are the ramp or come before it: `hold_s` before a ramp of 40 s.
    Nor which distribution ("univariate") the coefficients have, nor of what the series is: here standard normal, rad/s,
    of the velocity, as eq. (17) learns it. With U(-1, 1) the published estimator locks in 1 motion of 16.
    """
    rng = np.random.default_rng([3, seed])
    time_s = np.arange(int((hold_s + RAMP_S) / INTERVAL_S)) * INTERVAL_S
    frequency = SLOWEST + (FASTEST - SLOWEST) * np.clip((time_s - hold_s) / RAMP_S, 0.0, 1.0)
    phase = np.cumsum(frequency) * INTERVAL_S
    cosine, sine = rng.standard_normal((2, SWEEP_HARMONICS))
    angle = np.outer(phase, np.arange(1, SWEEP_HARMONICS + 1))
    return _sensed(rng, np.cos(angle) @ cosine + np.sin(angle) @ sine, phase, SLOWEST)


def random_periodic(seed: int) -> JointMotion:
    """Set R of the rhythm scoreboard, its velocity scaled to an RMS of 0.5 to 4 rad/s."""
    rng = np.random.default_rng([4, seed])
    motion = random_motion(seed)
    velocity = motion.velocity[:, 0]
    rms = np.exp(rng.uniform(np.log(WEAKEST), np.log(STRONGEST)))
    velocity = velocity * rms / np.sqrt(np.mean(velocity**2))
    return _sensed(rng, velocity, motion.phase, float(motion.frequency[0]))


def knee(seed: int, shapes: StrideShapes, *, stops: bool = False) -> JointMotion:
    """A walking knee whose strides differ by 2 to 5 %; with `stops` it stands for 2 to 10 s in between."""
    rng = np.random.default_rng([5, seed])
    motion = gait_motion(seed, "stop" if stops else "plain", shapes)
    return _sensed(rng, motion.velocity[:, KNEE], motion.phase, float(np.median(motion.frequency)))


def stumbling_knee(seed: int, shapes: StrideShapes) -> JointMotion:
    """A walking knee that stumbles three times: a jolt of 0.3 s, and the stride goes on elsewhere in its phase."""
    rng = np.random.default_rng([6, seed])
    velocity = gait_motion(seed, "plain", shapes, 80.0).velocity[:, KNEE]
    time_s = np.arange(velocity.size) * INTERVAL_S
    for second in np.sort(rng.uniform(15.0, 55.0, 3)):
        at, skipped = int(second / INTERVAL_S), int(rng.uniform(0.2, 1.0) / INTERVAL_S)
        seam = np.clip((np.arange(velocity.size - skipped) - at) * INTERVAL_S / 0.1, 0.0, 1.0)
        velocity = (1.0 - seam) * velocity[:-skipped] + seam * velocity[skipped:]
        jolt = np.clip((time_s[: velocity.size] - second) / 0.3, 0.0, 1.0)
        velocity = velocity + rng.choice([-1.0, 1.0]) * rng.uniform(2.0, 6.0) * np.sin(np.pi * jolt) ** 2
    return _sensed(rng, velocity[: int(60.0 / INTERVAL_S)], None, WALKING)


def smooth(seed: int) -> JointMotion:
    """Random smooth motion without period, RMS 0.5 to 4 rad/s, 60 s: noise in a band about 0.4 to 1.5 Hz.

    The band is 0.1 to 0.6 of its centre wide (standard deviation), so that some of them look periodic for a while.
    """
    rng = np.random.default_rng([7, seed])
    count = int(60.0 / INTERVAL_S)
    frequency_hz = np.fft.rfftfreq(count, INTERVAL_S)
    centre_hz, width = rng.uniform(0.4, 1.5), rng.uniform(0.1, 0.6)
    shape = np.exp(-0.5 * ((frequency_hz / centre_hz - 1.0) / width) ** 2) * (frequency_hz > 0.1)
    drawn = rng.standard_normal((frequency_hz.size, 2)) @ np.array([1.0, 1.0j])
    velocity = np.fft.irfft(shape * drawn, count)
    rms = np.exp(rng.uniform(np.log(WEAKEST), np.log(STRONGEST)))
    return _sensed(rng, velocity * rms / np.sqrt(np.mean(velocity**2)), None, WALKING)


def reaches(seed: int) -> JointMotion:
    """Single movements as in sit-to-stand: minimum-jerk from angle to angle in 0.5 to 2 s, rests of 0 to 3 s."""
    rng = np.random.default_rng([8, seed])
    velocity = np.zeros(int(60.0 / INTERVAL_S))
    at, angle = int(rng.uniform(0.5, 2.0) / INTERVAL_S), 0.0
    while at < velocity.size:
        target, count = rng.uniform(-1.5, 1.5), int(rng.uniform(0.5, 2.0) / INTERVAL_S)
        share = np.arange(count) / count
        movement = (target - angle) / (count * INTERVAL_S) * 30.0 * (share - share**2) ** 2
        velocity[at : at + count] = movement[: velocity.size - at]
        at, angle = at + count + int(rng.uniform(0.0, 3.0) / INTERVAL_S), target
    return _sensed(rng, velocity, None, WALKING)


def motion_kinds(shapes: StrideShapes | None) -> dict[str, Callable[[int], JointMotion]]:
    """Generators by name; those that need optical strides only where there are some."""
    kinds: dict[str, Callable[[int], JointMotion]] = {"random": random_periodic, "smooth": smooth, "reaches": reaches}
    if shapes is not None:
        kinds["knee"] = partial(knee, shapes=shapes)
        kinds["knee, stops"] = partial(knee, shapes=shapes, stops=True)
        kinds["knee, stumbles"] = partial(stumbling_knee, shapes=shapes)
    return kinds


def _sensed(rng: np.random.Generator, velocity: FloatArray, phase: FloatArray | None, frequency: float) -> JointMotion:
    """The motion with these velocities, swinging about straight down, and its samples."""
    time_s = np.arange(velocity.size) * INTERVAL_S
    spline = CubicSpline(time_s, velocity)
    angle = spline.antiderivative()(time_s)
    state = np.stack([angle - np.mean(angle), velocity, spline(time_s, 1)], axis=1)
    guess = frequency * (1.0 + 0.15 * float(rng.choice([-1.0, 1.0])))
    noise = rng.standard_normal((velocity.size, 3)) * np.sqrt(SENSOR.variances)
    return JointMotion(state, spline(time_s, 2), perfect_samples(state) + noise, phase, frequency, guess)


def perfect_samples(state: FloatArray) -> FloatArray:
    """Gyro, radial and tangential specific force without noise, (n, 3), by differentiating the sensor's path twice.

    Path L (sin q, -cos q) in a plane with the second axis up; written independently of the filter's equations.
    """
    q, dq, ddq = state.T
    outward = np.stack([np.sin(q), -np.cos(q)], axis=1)
    ahead = np.stack([np.cos(q), np.sin(q)], axis=1)
    acceleration = SENSOR.offset_m * (ddq[:, None] * ahead - (dq**2)[:, None] * outward)
    force = acceleration + np.array([0.0, GRAVITY])
    return np.stack([dq, np.sum(force * outward, axis=1), np.sum(force * ahead, axis=1)], axis=1)
