"""How fast strides follow each other: at a pace of one's own, or after a metronome."""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.interpolate import CubicSpline

from services.ingest.synthetic.jets import Array, Jet, smooth_step

_WANDER_HZ = (0.05, 0.083, 0.13)
"""Hz, slow components of the cadence's wander; their periods share no multiple within minutes."""
BEAT_FOLLOWED_S = 2.0
"""s that a person takes to follow a new beat."""


class Tempo(Protocol):
    """Strides over time."""

    @property
    def frequency_hz(self) -> float:
        """Strides per second, nominal."""

    def walked(self, start_s: float, time_s: Array) -> Jet:
        """Strides since `start_s`, with their first two derivatives."""


@dataclass(frozen=True)
class OwnPace:
    """A steady pace that wanders slowly: frequency x (1 + sum of a sin(w t + p))."""

    frequency_hz: float
    wander: tuple[tuple[float, float, float], ...]  # amplitude relative, rad/s, rad

    @classmethod
    def drawn(cls, frequency_hz: float, wander: float, seed: int) -> "OwnPace":
        """With a wander of that relative standard deviation, its phases from the seed."""
        rng = np.random.default_rng([seed, 1])
        share = wander * math.sqrt(2 / len(_WANDER_HZ))
        parts = tuple(
            (share, 2 * math.pi * hz * rng.uniform(0.8, 1.25), rng.uniform(0, 2 * math.pi)) for hz in _WANDER_HZ
        )
        return cls(frequency_hz, parts)

    def walked(self, start_s: float, time_s: Array) -> Jet:
        """The integral of the frequency."""
        strides, rate = time_s - start_s, np.ones_like(time_s)
        slope = np.zeros_like(time_s)
        for amplitude, angular, offset in self.wander:
            angle = angular * time_s + offset
            strides = strides + amplitude / angular * (math.cos(angular * start_s + offset) - np.cos(angle))
            rate = rate + amplitude * np.sin(angle)
            slope = slope + amplitude * angular * np.cos(angle)
        return Jet(strides, rate, slope).scaled(self.frequency_hz)


@dataclass(frozen=True)
class Metronome:
    """A beat for each stride; beat k, 1/s, holds from changes_s[k] on, and is reached within BEAT_FOLLOWED_S."""

    beats_hz: tuple[float, ...]
    changes_s: tuple[float, ...]

    @property
    def frequency_hz(self) -> float:
        """The first beat."""
        return self.beats_hz[0]

    def walked(self, start_s: float, time_s: Array) -> Jet:
        """The integral of the beat."""
        return _apart(self._beaten(time_s), self._beaten(np.array([start_s])))

    def _beaten(self, time_s: Array) -> Jet:
        strides = self.beats_hz[0] * time_s
        rate, slope = np.full_like(time_s, self.beats_hz[0]), np.zeros_like(time_s)
        for before, beat, at_s in zip(self.beats_hz, self.beats_hz[1:], self.changes_s[1:], strict=False):
            part, step = beat - before, smooth_step(at_s, at_s + BEAT_FOLLOWED_S)
            value, first, _ = step(time_s)
            strides = strides + part * _integral_of_step(time_s, at_s)
            rate, slope = rate + part * value, slope + part * first
        return Jet(strides, rate, slope)


def _integral_of_step(time_s: Array, at_s: float) -> Array:
    """Of smooth_step over BEAT_FOLLOWED_S: width u^5 (7 - 14 u + 10 u^2 - 2.5 u^3), then one for one."""
    u = np.clip((time_s - at_s) / BEAT_FOLLOWED_S, 0.0, 1.0)
    within = BEAT_FOLLOWED_S * u**5 * (7 + u * (-14 + u * (10 - 2.5 * u)))
    return np.asarray(within + np.maximum(time_s - at_s - BEAT_FOLLOWED_S, 0.0))


@dataclass(frozen=True)
class Jittered:
    """A tempo whose strides begin a little early or late, without drifting away from it."""

    tempo: Tempo
    early: CubicSpline  # strides over s

    @property
    def frequency_hz(self) -> float:
        """That of the tempo."""
        return self.tempo.frequency_hz

    def walked(self, start_s: float, time_s: Array) -> Jet:
        """The tempo's strides and the jitter's."""
        return self.tempo.walked(start_s, time_s) + _apart(
            jet_of(self.early, time_s), jet_of(self.early, np.array([start_s]))
        )


def _apart(now: Jet, before: Jet) -> Jet:
    return now.shifted(-float(before.value[0]))


def jet_of(spline: CubicSpline, time_s: Array) -> Jet:
    """A spline over s with its derivatives."""
    value, rate, slope = (np.asarray(spline(time_s, order)) for order in range(3))
    return Jet(value, rate, slope)


def random_spline(std: float, interval_s: float, duration_s: float, rng: np.random.Generator) -> CubicSpline:
    """Through independent normal values, one every `interval_s`, clipped at 2.5 standard deviations."""
    count = math.ceil(duration_s / interval_s) + 3
    values = std * np.clip(rng.standard_normal(count), -2.5, 2.5)
    return CubicSpline(np.arange(-1, count - 1) * interval_s, values)
