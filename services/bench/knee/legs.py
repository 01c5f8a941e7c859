"""A synthetic leg with two sensors and a known knee: any motion, mounting, bias, noise and soft tissue.

Segments are ISB (x forward, y up, z right); the thigh is inclined by a turn about z (forward positive), the knee bends
about -z. A gyroscope's sample is the mean over the interval that ends with it, an accelerometer's the instant's value.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]
Curve = Callable[[Array], Array]
"""Of time in s, (n,), to rad or m, (n,)."""

GRAVITY = 9.81
STEP_S = 1e-3
"""s of the central difference that gives accelerations."""
FLEXION_AXIS = np.array([0.0, 0.0, -1.0])
SENSORS_FROM_KNEE = np.array([[0.05, 0.15, 0.05], [0.03, -0.15, 0.04]])
"""m, in thigh and shank: both on the outer front side."""


class Motion(NamedTuple):
    """What the leg does."""

    thigh: Curve  # rad, forward positive
    knee: Curve  # rad, flexion positive
    heading: Curve  # rad about the vertical
    lean: Curve  # rad, thigh about its x axis
    hip_height: Curve  # m
    hip_forward: Curve  # m along the heading at the start


@dataclass(frozen=True)
class Sensors:
    """How the sensors are worn and what they add."""

    R_sensor_from_segment: Array = field(default_factory=lambda: np.tile(np.eye(3), (2, 1, 1)))
    gyro_bias: Array = field(default_factory=lambda: np.zeros((2, 3)))  # rad/s
    rate_noise: float = 0.0  # rad/s a sample
    force_noise: float = 0.0  # m/s^2 a sample
    soft_tissue: float = 0.0  # rad: wobble of the thigh's sensor, in step with the knee
    sliding: Array = field(default_factory=lambda: np.zeros((2, 3)))  # rad: of either sensor about its segment's axes


class LegRecording(NamedTuple):
    """Samples of both sensors and the truth."""

    rate: Array  # (n, 2, 3) rad/s
    force: Array  # (n, 2, 3) m/s^2
    flexion: Array  # (n,) rad
    axes: Array  # (2, 3) flexion axis in each sensor


def wave(amplitude: float, frequency_hz: float, mean: float = 0.0, phase: float = 0.0) -> Curve:
    """mean + amplitude sin(2 pi f t + phase)."""
    return lambda t: mean + amplitude * np.sin(2.0 * np.pi * frequency_hz * t + phase)


def still(value: float = 0.0) -> Curve:
    """A constant."""
    return lambda t: np.full_like(t, value)


def after(start_s: float, curve: Curve, before: float = 0.0, fade_s: float = 1.0) -> Curve:
    """`before` until start_s, then over to the curve within fade_s, smooth in acceleration."""

    def blended(t: Array) -> Array:
        share = np.clip((t - start_s) / fade_s, 0.0, 1.0)
        share = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
        return np.asarray((1.0 - share) * before + share * curve(t))

    return blended


def walking(cadence_hz: float = 0.9, start_s: float = 3.0) -> Motion:
    """Standing, then walking on the spot of a treadmill: swing of the thigh, two waves of the knee, sway."""
    f = cadence_hz

    def knee(t: Array) -> Array:
        phase = 2.0 * np.pi * f * t
        return np.asarray(0.42 - 0.42 * np.cos(phase - 1.2) + 0.12 * np.cos(2.0 * phase))

    return Motion(
        after(start_s, wave(0.38, f, 0.12)), after(start_s, knee), after(start_s, wave(0.07, f, 0.0, 0.4)),
        after(start_s, wave(0.05, f, 0.0, 1.0)), after(start_s, wave(0.02, 2.0 * f)),
        after(start_s, wave(0.03, 2.0 * f, 0.0, 1.5)),
    )  # fmt: skip


def seated_flexion(frequency_hz: float = 0.4, start_s: float = 3.0) -> Motion:
    """Sitting with the thigh nearly level: the shank swings from hanging to nearly straight."""
    knee = after(start_s, wave(0.6, frequency_hz, 0.85), before=1.4)
    small = after(start_s, wave(0.04, frequency_hz, 0.0, 0.7))
    thigh = after(start_s, wave(0.06, frequency_hz, 1.35, 0.3), before=1.35)
    return Motion(thigh, knee, small, small, still(), still())


def cycling(frequency_hz: float = 1.0, start_s: float = 3.0) -> Motion:
    """Pedalling: thigh and knee in step, the hip nearly at rest."""
    thigh = after(start_s, wave(0.38, frequency_hz, 0.95), before=0.95)
    knee = after(start_s, wave(0.6, frequency_hz, 1.2, 0.3), before=1.2)
    small = after(start_s, wave(0.03, frequency_hz, 0.0, 1.0))
    return Motion(thigh, knee, small, small, after(start_s, wave(0.005, frequency_hz)), still())


def sit_to_stand(period_s: float = 4.0, start_s: float = 3.0) -> Motion:
    """Standing, then sitting down and standing up: the thigh turns level while the shank stays upright."""
    f = 1.0 / period_s

    def knee(t: Array) -> Array:
        return np.asarray(0.8 - 0.8 * np.cos(2.0 * np.pi * f * (t - start_s)))

    def thigh(t: Array) -> Array:
        return np.asarray(0.9 * knee(t))

    small = after(start_s, wave(0.03, 2.0 * f))
    return Motion(
        after(start_s, thigh), after(start_s, knee), small, small,
        after(start_s, lambda t: -0.2 * knee(t)), after(start_s, lambda t: -0.2 * knee(t)),
    )  # fmt: skip


def record(
    motion: Motion, duration_s: float, rate_hz: float, sensors: Sensors = Sensors(), seed: int = 0
) -> LegRecording:
    """Samples of both sensors at `rate_hz`, and the flexion of the knee at each."""
    t = np.arange(1, int(duration_s * rate_hz) + 1) / rate_hz
    draw = np.random.default_rng(seed)
    rate, force = np.empty((len(t), 2, 3)), np.empty((len(t), 2, 3))
    for s in range(2):
        now, before = orientation(motion, sensors, s, t), orientation(motion, sensors, s, t - 1.0 / rate_hz)
        rate[:, s] = (before.inv() * now).as_rotvec() * rate_hz + sensors.gyro_bias[s]
        points = [_position(motion, s, t + k * STEP_S) for k in (-1, 0, 1)]
        acceleration = (points[0] - 2.0 * points[1] + points[2]) / STEP_S**2
        force[:, s] = now.inv().apply(acceleration + np.array([0.0, GRAVITY, 0.0]))
    rate += sensors.rate_noise * draw.standard_normal(rate.shape)
    force += sensors.force_noise * draw.standard_normal(force.shape)
    return LegRecording(rate, force, motion.knee(t), sensors.R_sensor_from_segment @ FLEXION_AXIS)


def _segment(motion: Motion, segment: int, t: Array) -> Rotation:
    """World from thigh (0) or shank (1): heading about y, lean about x, inclination about z, knee about -z."""
    bent = motion.thigh(t) - (motion.knee(t) if segment else 0.0)
    return Rotation.from_euler("YXZ", np.stack([motion.heading(t), motion.lean(t), bent], axis=1))


def orientation(motion: Motion, sensors: Sensors, s: int, t: Array) -> Rotation:
    """World from sensor `s` at times t (n,) in s, as `record` has it."""
    return _segment(motion, s, t) * segment_from_sensor(motion, sensors, s, t)


def segment_from_sensor(motion: Motion, sensors: Sensors, s: int, t: Array) -> Rotation:
    """How the sensor lies on its bone: it wobbles about its segment's axes in step with the knee."""
    bend, mounted = motion.knee(t), Rotation.from_matrix(sensors.R_sensor_from_segment[s].T)
    wobble = sensors.sliding[s] * np.stack([np.sin(3.0 * bend), np.sin(2.0 * bend), np.cos(4.0 * bend)], 1)
    if s == 0 and sensors.soft_tissue > 0.0:
        wobble += sensors.soft_tissue * np.stack([0.7 * np.sin(3.0 * bend), np.sin(2.0 * bend), np.cos(4.0 * bend)], 1)
    return Rotation.from_rotvec(wobble) * mounted


def _position(motion: Motion, s: int, t: Array) -> Array:
    hip = np.stack([motion.hip_forward(t), motion.hip_height(t), np.zeros_like(t)], axis=1)
    knee = hip + _segment(motion, 0, t).apply([0.0, -0.42, 0.0])
    return np.asarray(knee + _segment(motion, s, t).apply(SENSORS_FROM_KNEE[s]))
