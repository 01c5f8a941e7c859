"""The knee band beside the published one: any rate, axes in any direction, biases told while it runs, usable at once.

Each segment has an inclination about the flexion axis and a gyroscope bias. The specific force is averaged in the
upright frame that the gyroscope keeps, and believed the less, the less of it lies across the axis. What the angle is
worth is said from the first sample on.
"""

from cmath import phase, rect
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
    """rad. Inclination by gravity, averaged: soft tissue and calibration."""
    level_time_s: float = 2.1
    """s. Averaging of the specific force in the upright frame; as `LevelParameters`."""
    dynamic_gain: float = 1.0
    """Error of the first sample's inclination, rad, for a specific force that differs from gravity by g."""
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
        self.mean, self.elapsed_s = 0j, 0.0

    def step(self, rate: float, along: float, across: float, force: float, dt_s: float) -> None:
        """Rate about the axis (rad/s); specific force along and across the reference direction, and its length."""
        parameters = self.parameters
        if not isfinite(self.p00):
            dynamic = parameters.dynamic_gain * (force - GRAVITY) / GRAVITY
            self.angle = atan2(across, along)
            self.p00 = (parameters.tilt_std**2 + dynamic**2) / self._share(along, across)
            self.mean, self.elapsed_s = complex(abs(complex(along, across)), 0.0), dt_s
            return
        self.elapsed_s += dt_s
        self.angle += (rate - self.bias) * dt_s
        self.p00 += dt_s * (-2.0 * self.p01 + dt_s * self.p11 + parameters.rate_noise**2)
        self.p01 -= dt_s * self.p11
        self.p11 += dt_s * parameters.bias_wander**2
        # In the upright frame gravity stands still and motion averages out.
        gain = dt_s / min(self.elapsed_s, parameters.level_time_s)
        self.mean += gain * (complex(along, across) * rect(1.0, -self.angle) - self.mean)
        self._correct(phase(self.mean), self._share(self.mean.real, self.mean.imag), dt_s)

    def _correct(self, innovation: float, share: float, dt_s: float) -> None:
        """Kalman update by the mean's inclination, whose errors live as long as the mean."""
        parameters = self.parameters
        noise = parameters.tilt_std**2 / share * max(1.0, 2.0 * parameters.level_time_s / dt_s)
        gain_angle, gain_bias = self.p00 / (self.p00 + noise), self.p01 / (self.p00 + noise)
        self.angle += gain_angle * innovation
        self.mean *= rect(1.0, -gain_angle * innovation)
        self.bias = min(max(self.bias + gain_bias * innovation, -parameters.largest_bias), parameters.largest_bias)
        self.p11 -= gain_bias * self.p01
        self.p00, self.p01 = (1.0 - gain_angle) * self.p00, (1.0 - gain_angle) * self.p01

    @staticmethod
    def _share(along: float, across: float) -> float:
        """Square of the share of gravity that lies across the axis: a shorter projection tells the angle less well."""
        return min(1.0, max((along * along + across * across) / GRAVITY**2, 1e-6))


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
            name: [
                i.angle,
                i.bias,
                i.p00 if isfinite(i.p00) else None,
                i.p01,
                i.p11,
                i.mean.real,
                i.mean.imag,
                i.elapsed_s,
            ]
            for name, i in (("thigh", self.thigh), ("shank", self.shank))
        }

    def restore(self, state: State) -> None:
        """Go on from a snapshot of a band with the same axes."""
        for name, i in (("thigh", self.thigh), ("shank", self.shank)):
            i.angle, i.bias, p00, i.p01, i.p11, along, across, i.elapsed_s = state[name]
            i.mean = complex(along, across)
            i.p00 = inf if p00 is None else p00
