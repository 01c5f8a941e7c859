"""A known waveform: recognised within a stride, never believed when it is wrong, and used after a stop."""

import json

import numpy as np
import pytest
from numpy.typing import NDArray

from services.biomech.rhythm.trusted import TrustedRhythm

DT_S = 0.01
CHANNELS, HARMONICS = 4, 7
STAND_S, FREQUENCY = 2.0, 2.0 * np.pi * 0.9
PHASE, RATE, QUALITY, LOCK = range(4)


def person(seed: int) -> NDArray[np.float64]:
    """Coefficients (2, 4, 7) of velocity, rad/s; the first two harmonics hold most of the power."""
    rng = np.random.default_rng(seed)
    drawn = rng.standard_normal((2, CHANNELS, HARMONICS)) / np.arange(1, HARMONICS + 1) ** 1.5
    return np.asarray(2.0 * drawn / np.sqrt((drawn**2).sum() / CHANNELS))


def played(waveform: NDArray[np.float64], phase: NDArray[np.float64]) -> NDArray[np.float64]:
    angle = np.outer(phase, np.arange(1, waveform.shape[2] + 1))
    return np.asarray(np.cos(angle) @ waveform[0].T + np.sin(angle) @ waveform[1].T)


def walk(
    waveform: NDArray[np.float64], frequency: float = FREQUENCY, seconds: float = 9.0, start: float = 1.0, seed: int = 0
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Standing, then walking from a phase on; velocities (n, 4) with sensor noise, and the true phase (n,)."""
    time_s = np.arange(int((STAND_S + seconds) / DT_S)) * DT_S
    phase = start + frequency * np.maximum(time_s - STAND_S, 0.0)
    grown = np.clip((time_s - STAND_S) / 0.3, 0.0, 1.0)[:, None]
    noise = np.random.default_rng([9, seed]).standard_normal((time_s.size, CHANNELS))
    return played(waveform, phase) * grown + 0.05 * noise, phase


def readings(
    velocity: NDArray[np.float64], known: NDArray[np.float64] | None = None, frequency: float = FREQUENCY
) -> NDArray[np.float64]:
    estimator = TrustedRhythm(CHANNELS)
    if known is not None:
        estimator.start_from(known, frequency)
    return estimator.run(np.ascontiguousarray(velocity), DT_S)


def strides_to_lock(result: NDArray[np.float64], frequency: float = FREQUENCY) -> float:
    return float((np.argmax(result[:, LOCK] > 0.5) * DT_S - STAND_S) * frequency / (2.0 * np.pi))


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("change", [0.85, 1.0, 1.15])
def test_a_known_stride_is_locked_within_one_stride_at_the_phase_it_was_learned_with(seed, change):
    frequency = change * FREQUENCY
    velocity, phase = walk(1.1 * change * person(seed), frequency, start=float(seed))
    result = readings(velocity, person(seed))
    assert strides_to_lock(result, frequency) < 1.0
    locked = result[:, LOCK] > 0.5
    assert locked[int(4.0 / DT_S) :].all()
    apart = np.angle(np.exp(1j * (result[:, PHASE] - phase)))[locked]
    assert np.abs(apart).max() < 0.35
    assert np.abs(apart[-300:]).max() < 0.1


@pytest.mark.parametrize("wrong", ["person", "half", "double", "backwards"])
def test_a_wrong_waveform_changes_neither_the_lock_nor_the_frequency(wrong):
    own = person(1)
    known = {"person": person(2), "backwards": own * np.array([1.0, -1.0])[:, None, None]}.get(wrong, own)
    frequency = {"half": 0.5 * FREQUENCY, "double": 2.0 * FREQUENCY}.get(wrong, FREQUENCY)
    velocity, _ = walk(own)
    warm, cold = readings(velocity, known, frequency), readings(velocity)
    assert np.array_equal(warm[:, LOCK], cold[:, LOCK])
    # The known waveform still is the reference of the phase, which rounds differently.
    assert warm[:, RATE:] == pytest.approx(cold[:, RATE:], abs=1e-9)


def test_a_lock_that_proves_wrong_ends_within_a_stride_and_the_cold_start_is_not_late():
    own, other = person(1), person(2)
    velocity, phase = walk(own, start=0.0)
    change = int((STAND_S + 0.95 * 2.0 * np.pi / FREQUENCY) / DT_S)
    velocity[change:] = played(other, 1.4 * phase[change:]) + 0.05
    warm, cold = readings(velocity, own), readings(velocity)
    assert (warm[:change, LOCK] > 0.5).any()
    ended = change + np.argmax(warm[change:, LOCK] < 0.5)
    assert (ended - change) * DT_S * FREQUENCY / (2.0 * np.pi) < 1.0
    assert np.argmax(cold[:, LOCK] > 0.5) >= ended
    again = ended + np.argmax(warm[ended:, LOCK] > 0.5)
    assert again <= np.argmax(cold[:, LOCK] > 0.5)


def test_nothing_is_recognised_in_standing():
    velocity, _ = walk(person(1), seconds=0.0)
    quiet = np.tile(velocity, (5, 1))
    assert not (readings(quiet, person(1))[:, LOCK] > 0.5).any()


def test_after_a_stop_the_walk_is_recognised_by_what_was_learned_before_it():
    velocity, _ = walk(person(3), seconds=15.0)
    twice = np.concatenate([velocity, velocity])
    result = readings(twice)
    second = result[len(velocity) :].copy()
    second[: int(STAND_S / DT_S), LOCK] = 0.0
    assert 0.0 < strides_to_lock(second) < 1.0
    assert not (result[len(velocity) + 100 : len(velocity) + 200, LOCK] > 0.5).any()
    assert strides_to_lock(result) > 1.5


def test_more_or_fewer_harmonics_than_the_estimator_has_are_taken_as_far_as_they_go():
    velocity, _ = walk(person(1))
    padded = np.concatenate([person(1), np.zeros((2, CHANNELS, 5))], axis=2)
    assert np.array_equal(readings(velocity, padded), readings(velocity, person(1)))
    assert strides_to_lock(readings(velocity, person(1)[:, :, :5])) < 1.1


@pytest.mark.parametrize("split_s", [1.0, 2.5, 3.3, 4.2, 6.0])
def test_split_and_resume_with_a_known_waveform_is_bit_identical(split_s):
    velocity, _ = walk(person(4))
    velocity = np.ascontiguousarray(velocity)
    whole = readings(velocity, person(4))
    first, second = TrustedRhythm(CHANNELS), TrustedRhythm(CHANNELS)
    first.start_from(person(4), FREQUENCY)
    at = int(split_s / DT_S)
    begun = first.run(velocity[:at], DT_S)
    second.restore(json.loads(json.dumps(first.snapshot())))
    assert np.array_equal(np.concatenate([begun, second.run(velocity[at:], DT_S)]), whole)


def test_extreme_input_with_a_known_waveform_leaves_everything_finite():
    rng = np.random.default_rng(5)
    estimator = TrustedRhythm(CHANNELS)
    estimator.start_from(person(1), FREQUENCY)
    for _ in range(3000):
        sample = rng.choice([np.nan, np.inf, -np.inf, 1e300, 0.0, 1.0, -80.0], CHANNELS)
        reading = estimator.step(sample, float(rng.choice([0.01, 0.0, -1.0, 0.05])))
        assert np.isfinite(reading[:3]).all()
        assert np.isfinite(reading.jerk).all()
