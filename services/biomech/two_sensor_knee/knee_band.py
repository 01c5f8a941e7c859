"""The knee band beside the published one: any rate, axes in any direction, biases told while it runs, usable at once.

Each segment has an inclination about the flexion axis and a gyroscope bias. Gravity is believed the less, the more
the specific force differs from it and the less of it lies across the axis. What the angle is worth is said from the
first sample on.
"""

from dataclasses import dataclass
from math import atan2, inf, isfinite, radians, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.rotations import normalised
from services.biomech.two_sensor_knee.grover import wrapped
from services.flow.node import State

GRAVITY = 9.81
Array = NDArray[np.float64]


@dataclass(frozen=True)
class BandParameters:
    """Tunables; [T] chosen on weygers_hinge 02."""

    rate_noise: float = radians(0.3)
    """rad/s/sqrt(Hz). Gyroscope, scale and axis. [T]"""
    bias_wander: float = radians(0.01)
    """rad/s/sqrt(s)."""
    start_bias_std: float = radians(1.0)
    """rad/s."""
    tilt_std: float = radians(2.0)
    """rad. Inclination by gravity at rest: soft tissue and calibration."""
    tilt_correlation_s: float = 0.1
    """s. Errors of gravity live this long, so a faster sensor does not know more. [T]"""
    dynamic_gain: float = 4.0
    """Tilt error, in rad, for a specific force that differs from gravity by g. [T]"""
    largest_bias: float = radians(5.0)
    """rad/s."""


class BandReading(NamedTuple):
    """Flexion about the given axes, rad; 0 where both sensors' reference directions are parallel."""

    flexion: float
    flexion_std: float
    is_valid: bool


class Inclination:
    """One segment: angle about the flexion axis against the vertical, and gyroscope bias."""

    def __init__(self, parameters: BandParameters) -> None:
        self.parameters = parameters
        self.angle, self.bias = 0.0, 0.0
        self.p00, self.p01, self.p11 = inf, 0.0, parameters.start_bias_std**2

    def step(self, rate: float, along: float, across: float, force: float, dt_s: float) -> None:
        """Rate about the axis (rad/s); specific force along and across the reference direction, and its length."""
        parameters = self.parameters
        noise = self._tilt_variance(along, across, force)
        measured = atan2(across, along)
        if not isfinite(self.p00):
            self.angle, self.p00 = measured, noise
            return
        self.angle += (rate - self.bias) * dt_s
        self.p00 += dt_s * (-2.0 * self.p01 + dt_s * self.p11 + parameters.rate_noise**2)
        self.p01 -= dt_s * self.p11
        self.p11 += dt_s * parameters.bias_wander**2
        # Errors that live for a while count once in that while, not at every sample.
        scale = self.p00 + noise * max(1.0, parameters.tilt_correlation_s / dt_s)
        gain_angle, gain_bias = self.p00 / scale, self.p01 / scale
        innovation = wrapped(measured - self.angle)
        self.angle += gain_angle * innovation
        self.bias = min(max(self.bias + gain_bias * innovation, -parameters.largest_bias), parameters.largest_bias)
        self.p11 -= gain_bias * self.p01
        self.p00, self.p01 = (1.0 - gain_angle) * self.p00, (1.0 - gain_angle) * self.p01

    def _tilt_variance(self, along: float, across: float, force: float) -> float:
        """rad^2. A shorter projection tells the direction less well; other accelerations mislead it."""
        share = max(sqrt(along * along + across * across) / GRAVITY, 1e-3)
        dynamic = self.parameters.dynamic_gain * (force - GRAVITY) / GRAVITY
        return (self.parameters.tilt_std**2 + dynamic**2) / share**2


class KneeBand:
    """Knee flexion from inclinations about given flexion axes.

    The axes may be those of the band itself or those that `KneeAxis` found; they may be improved while it runs.
    """

    def __init__(self, axes: Array, references: Array, parameters: BandParameters = BandParameters()) -> None:
        """Axes and references (2, 3) in the frames of thigh and shank sensor: flexion axis, and a direction that is
        parallel for both sensors at flexion 0 (its part along the axis does not matter)."""
        self.parameters = parameters
        self.thigh, self.shank = Inclination(parameters), Inclination(parameters)
        self.aim(axes, references)

    def aim(self, axes: Array, references: Array) -> None:
        """Go on with other axes and references (2, 3).

        Raises:
            ValueError: a reference is parallel to its axis.
        """
        self._axes = np.stack([normalised(axis) for axis in axes])
        along = references - np.sum(references * self._axes, axis=1)[:, None] * self._axes
        self._along = np.stack([normalised(direction) for direction in along])
        self._across = np.cross(self._axes, self._along)

    def step(self, rate: Array, force: Array, dt_s: float) -> BandReading:
        """Take one sample: rate (2, 3) rad/s, specific force (2, 3) m/s^2, dt_s after the sample before.

        A sample that is not finite is left out; the deviation grows.
        """
        usable = dt_s > 0.0 and bool(np.isfinite(rate).all() and np.isfinite(force).all())
        for s, segment in enumerate((self.thigh, self.shank)):
            if usable:
                length = float(np.linalg.norm(force[s]))
                # The vertical seen from a segment that turns by +a turns by -a.
                along, across = float(force[s] @ self._along[s]), -float(force[s] @ self._across[s])
                segment.step(float(rate[s] @ self._axes[s]), along, across, length, dt_s)
            elif dt_s > 0.0:
                segment.p00 += dt_s
        variance = self.thigh.p00 + self.shank.p00
        flexion = wrapped(self.shank.angle - self.thigh.angle)
        return BandReading(flexion, sqrt(variance), usable and variance < 1.0)

    def snapshot(self) -> State:
        """Everything that changes, as JSON values."""
        return {
            name: [i.angle, i.bias, i.p00 if isfinite(i.p00) else None, i.p01, i.p11]
            for name, i in (("thigh", self.thigh), ("shank", self.shank))
        }

    def restore(self, state: State) -> None:
        """Go on from a snapshot of a band with the same axes."""
        for name, i in (("thigh", self.thigh), ("shank", self.shank)):
            i.angle, i.bias, p00, i.p01, i.p11 = state[name]
            i.p00 = inf if p00 is None else p00
