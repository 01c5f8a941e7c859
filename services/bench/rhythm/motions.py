"""Motions the rhythm estimators are scored on: random periodic velocities (set R) and synthetic gait (set G).

All at 100 Hz, rad and rad/s. Numbers come from the seed alone, in a fixed order of draws, so a seed is a motion.
"""

from dataclasses import dataclass
from typing import Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from services.bench.rhythm.stride_shapes import StrideShapes

FloatArray = NDArray[np.float64]
Scenario = Literal["plain", "stop", "speed", "metro"]
Share = TypeVar("Share", float, FloatArray)

INTERVAL_S = 0.01
NOISE_RANDOM = 0.5  # rad/s, the gyro noise of the published simulation
NOISE_GAIT = 0.1  # rad/s
METRONOME_HZ = (1.167, 1.0, 0.833, 1.0, 1.167, 1.33)  # 30 s each
CYCLES_DRAWN = 400


@dataclass(frozen=True)
class Motion:
    """One motion: what a perfect and a noisy sensor see, and the truth about its rhythm."""

    velocity: FloatArray
    """rad/s, shape (n, channels), without noise."""
    measured: FloatArray
    """rad/s, shape (n, channels), with white noise."""
    phase: FloatArray
    """rad, shape (n,): true stride phase, unwrapped."""
    frequency: FloatArray
    """rad/s, shape (n,)."""
    guess: float
    """rad/s: frequency within +-50 % for estimators that must be told one."""
    event_s: tuple[float, float] | None = None
    """s: start and end of the stop or of the change of speed."""


def random_motion(seed: int, duration_s: float = 60.0) -> Motion:
    """Set R: one channel, 1 to 7 harmonics, 0.3-1.8 Hz, RMS 0.1-10 rad/s, half of them with drifting frequency."""
    rng = np.random.default_rng([1, seed])
    time_s = np.arange(int(duration_s / INTERVAL_S), dtype=np.float64) * INTERVAL_S
    frequency_hz = rng.uniform(0.3, 1.8)
    harmonics = int(rng.integers(1, 8))
    coefficients = _observable_coefficients(rng, harmonics, rng.uniform(0.0, 1.0))
    rms = np.exp(rng.uniform(np.log(0.1), np.log(10.0)))
    drift = rng.uniform(-0.2, 0.2) if rng.random() < 0.5 else 0.0
    drifting_hz = np.clip(frequency_hz * (1.0 + drift * time_s / duration_s), 0.3, 1.8)
    phase = 2.0 * np.pi * np.cumsum(drifting_hz) * INTERVAL_S
    velocity = rms * (np.exp(1j * np.outer(phase, np.arange(1, harmonics + 1))) @ coefficients).real
    measured = velocity + NOISE_RANDOM * rng.standard_normal(time_s.size)
    guess_hz = frequency_hz * (1.0 + rng.uniform(-0.5, 0.5))
    return Motion(velocity[:, None], measured[:, None], phase, 2.0 * np.pi * drifting_hz, float(2.0 * np.pi * guess_hz))


def _observable_coefficients(rng: np.random.Generator, harmonics: int, decay: float) -> NDArray[np.complex128]:
    """Complex coefficients of unit RMS whose period cannot be mistaken for its half, third or fifth.

    Redrawn until the harmonics not divisible by 2, 3 and 5 hold at least 5 % of the power each.
    """
    order = np.arange(1, harmonics + 1)
    while True:
        drawn = (rng.uniform(-1, 1, harmonics) + 1j * rng.uniform(-1, 1, harmonics)) / order**decay
        power = np.abs(drawn) ** 2
        if all(power[order % divisor != 0].sum() >= 0.05 * power.sum() for divisor in (2, 3, 5)):
            return np.asarray(drawn / np.sqrt(power.sum() / 2.0))


def gait_motion(seed: int, scenario: Scenario, shapes: StrideShapes, duration_s: float = 60.0) -> Motion:
    """Set G: knee left, knee right, thigh pitch left and right, from blends of optical strides.

    Each cycle has its own blend, amplitude per joint, harmonics and duration (2-5 % variability); half of the
    subjects have one leg scaled to 0.4-0.8.
    """
    rng = np.random.default_rng([2, seed])
    time_s = np.arange(int(duration_s / INTERVAL_S), dtype=np.float64) * INTERVAL_S
    cadence_hz = rng.uniform(0.4, 1.1)
    variability = rng.uniform(0.02, 0.05)
    scale = leg_scale(rng)
    nominal_hz, moving, event_s = _plan(rng, scenario, cadence_hz, time_s)
    wander = np.sin(2.0 * np.pi * time_s / rng.uniform(15.0, 40.0) + rng.uniform(0.0, 6.28))
    if scenario != "metro":
        nominal_hz *= 1.0 + 0.03 * wander
    pace = 1.0 + variability * rng.standard_normal(CYCLES_DRAWN)
    cycles = draw_cycles(rng, shapes, variability, scale)
    turns, frequency_hz = walk_cycles(rng, nominal_hz, pace, moving)
    angle = play_cycles(turns, cycles) * moving[:, None]
    velocity = np.gradient(angle, INTERVAL_S, axis=0)
    measured = velocity + NOISE_GAIT * rng.standard_normal(velocity.shape)
    guess = 2.0 * np.pi * cadence_hz * (1.0 + rng.uniform(-0.5, 0.5))
    return Motion(velocity, measured, 2.0 * np.pi * turns, 2.0 * np.pi * frequency_hz, float(guess), event_s)


def leg_scale(rng: np.random.Generator) -> FloatArray:
    """Amplitude of each joint, (4,): for every other person one leg is scaled to 0.4-0.8."""
    scale = np.ones(4)
    if rng.random() < 0.5:
        side = int(rng.integers(0, 2))
        scale[[side, side + 2]] = rng.uniform(0.4, 0.8)
    return scale


def _plan(
    rng: np.random.Generator, scenario: Scenario, cadence_hz: float, time_s: FloatArray
) -> tuple[FloatArray, FloatArray, tuple[float, float] | None]:
    """Nominal cadence, share of movement (0 = standing) and the event of a scenario."""
    cadence: FloatArray = np.full(time_s.size, cadence_hz)
    moving = np.ones(time_s.size)
    if scenario == "stop":
        start = rng.uniform(18.0, 22.0)
        end = start + rng.uniform(2.0, 10.0)
        ramp = np.clip(np.maximum(1.0 - (time_s - start) / 0.5, 1.0 - (end - time_s) / 0.5), 0.0, 1.0)
        return cadence, 0.5 - 0.5 * np.cos(np.pi * ramp), (start, end)
    if scenario == "speed":
        start = rng.uniform(25.0, 30.0)
        factor = float(rng.choice([0.7, 1.3]))
        return cadence * (1.0 + (factor - 1.0) * np.clip((time_s - start) / 2.0, 0.0, 1.0)), moving, (start, start + 2)
    if scenario == "metro":
        beats = np.array(METRONOME_HZ)[np.minimum(time_s // 30.0, len(METRONOME_HZ) - 1).astype(int)]
        cadence = np.convolve(np.pad(beats, 100, mode="edge"), np.full(201, 1.0 / 201.0), "valid")
    return cadence, moving, None


def draw_cycles(
    rng: np.random.Generator, shapes: StrideShapes, variability: float, leg_scale: FloatArray
) -> NDArray[np.complex128]:
    """Coefficients (cycle, joint, harmonic from 0) of each cycle, rad."""
    joints, orders = shapes.coefficients.shape[1:]
    amplitude = (1.0 + variability * rng.standard_normal((CYCLES_DRAWN, joints))) * leg_scale
    blend = rng.uniform(-0.3, 1.3, CYCLES_DRAWN)[:, None, None]
    cycles = ((1.0 - blend) * shapes.coefficients[0] + blend * shapes.coefficients[1]) * amplitude[:, :, None]
    cycles[:, :, 1:] *= 1.0 + variability * rng.standard_normal((CYCLES_DRAWN, joints, orders - 1))
    return np.asarray(cycles)


def walk_cycles(
    rng: np.random.Generator, nominal_hz: FloatArray, pace: FloatArray, moving: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Phase (turns) and frequency (Hz) of a walk whose cycles have their own pace, joined by smoothsteps.

    It goes on from a stop at a random phase.
    """
    turns, frequency_hz = np.empty(nominal_hz.size), np.empty(nominal_hz.size)
    turn, has_stood = rng.uniform(0.0, 1.0), False
    for i in range(nominal_hz.size):
        cycle = int(turn)
        mix = _smoothstep(turn - cycle)
        frequency_hz[i] = nominal_hz[i] * ((1.0 - mix) * pace[cycle] + mix * pace[cycle + 1])
        stands = moving[i] < 0.02
        if stands and not has_stood:
            turn += rng.uniform(0.0, 1.0)
            has_stood = True
        if not stands:
            turn += frequency_hz[i] * INTERVAL_S
        turns[i] = turn
    return turns, frequency_hz


def play_cycles(turns: FloatArray, cycles: NDArray[np.complex128]) -> FloatArray:
    """Angles (n, joint), rad, of the cycles at these phases."""
    cycle = turns.astype(int)
    fraction = turns - cycle
    mix = _smoothstep(fraction)[:, None, None]
    coefficients = (1.0 - mix) * cycles[cycle] + mix * cycles[cycle + 1]
    basis = np.exp(2j * np.pi * np.outer(fraction, np.arange(cycles.shape[2])))
    return np.asarray(np.einsum("njk,nk->nj", coefficients, basis).real)


def _smoothstep(share: Share) -> Share:
    return share * share * (3.0 - 2.0 * share)
