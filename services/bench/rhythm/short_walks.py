"""Short walks out of standing by people who walk more than once: what a rhythm that was learned before is scored on.

Every person has an own deformation of the optical strides, cadence and asymmetry; every trial of a person has its own
speed and amplitudes. All at 100 Hz; a person and a trial are numbers, so a seed is a walk.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.bench.rhythm.motions import (
    INTERVAL_S,
    NOISE_GAIT,
    Motion,
    draw_cycles,
    leg_scale,
    play_cycles,
    walk_cycles,
)
from services.bench.rhythm.stride_shapes import StrideShapes

FloatArray = NDArray[np.float64]

STANDING_S = 2.0
RAMP_S = 0.5
"""s in which a walk grows out of standing."""
DEFORMATION, TURN = 0.25, 0.3
"""Of a person's harmonics: standard deviation of their logarithm, and of their phase in rad."""
TRIAL_SPREAD = 0.1
"""Largest relative change of frequency, and of each joint's amplitude, from trial to trial."""


@dataclass(frozen=True)
class Person:
    """What stays the same from trial to trial."""

    seed: int
    shapes: StrideShapes
    cadence_hz: float
    variability: float
    leg_scale: FloatArray
    """(4,) amplitude of knee left, knee right, thigh left, thigh right."""


def draw_person(seed: int, shapes: StrideShapes) -> Person:
    """A person of that number."""
    rng = np.random.default_rng([3, seed])
    size = (1, *shapes.coefficients.shape[1:])
    factor = np.exp(DEFORMATION * rng.standard_normal(size) + 1j * TURN * rng.standard_normal(size))
    factor[:, :, 0] = 1.0
    own = StrideShapes(shapes.coefficients * factor)
    return Person(seed, own, rng.uniform(0.5, 1.1), rng.uniform(0.02, 0.05), leg_scale(rng))


def short_walk(person: Person, trial: int, walking_s: float, standing_s: float = STANDING_S) -> Motion:
    """Standing, then walking; the event is the time of walking (s)."""
    rng = np.random.default_rng([4, person.seed, trial])
    time_s = np.arange(int((standing_s + walking_s) / INTERVAL_S), dtype=np.float64) * INTERVAL_S
    cadence_hz = person.cadence_hz * (1.0 + rng.uniform(-TRIAL_SPREAD, TRIAL_SPREAD))
    amplitude = person.leg_scale * (1.0 + rng.uniform(-TRIAL_SPREAD, TRIAL_SPREAD, 4))
    ramp = np.clip((time_s - standing_s) / RAMP_S, 0.0, 1.0)
    moving = 0.5 - 0.5 * np.cos(np.pi * ramp)
    pace = 1.0 + person.variability * rng.standard_normal(400)
    cycles = draw_cycles(rng, person.shapes, person.variability, amplitude)
    turns, frequency_hz = walk_cycles(rng, np.full(time_s.size, cadence_hz), pace, moving)
    velocity = np.gradient(play_cycles(turns, cycles) * moving[:, None], INTERVAL_S, axis=0)
    measured = velocity + NOISE_GAIT * rng.standard_normal(velocity.shape)
    frequency = 2.0 * np.pi * frequency_hz
    return Motion(velocity, measured, 2.0 * np.pi * turns, frequency, float(frequency[-1]), (standing_s, time_s[-1]))


def restless(person: Person, trial: int, duration_s: float) -> FloatArray:
    """Motion without a period, as strong and as quick as the person's walking: rad/s, shape (n, 4)."""
    walk = short_walk(person, trial, duration_s, standing_s=0.0).velocity
    rng = np.random.default_rng([5, person.seed, trial])
    spectrum = np.fft.rfft(rng.standard_normal(walk.shape), axis=0)
    hertz = np.fft.rfftfreq(walk.shape[0], INTERVAL_S)
    spectrum *= (1.0 / (1.0 + (hertz / (2.0 * person.cadence_hz)) ** 4))[:, None]
    noise = np.fft.irfft(spectrum, walk.shape[0], axis=0)
    noise *= walk.std(axis=0) / noise.std(axis=0)
    return np.asarray(noise + NOISE_GAIT * rng.standard_normal(walk.shape))
