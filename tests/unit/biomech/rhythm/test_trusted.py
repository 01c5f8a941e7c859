"""The trusted rhythm: locks quickly and rightly, knows when not, keeps its reference, survives everything."""

import json

import numpy as np
import pytest
from numpy.typing import NDArray

from services.bench.rhythm.motions import random_motion
from services.bench.rhythm.scores import score_random
from services.biomech.rhythm.memory import LOCKED
from services.biomech.rhythm.parameters import TrustedParameters
from services.biomech.rhythm.trusted import TrustedRhythm

DT_S = 0.01
PHASE, FREQUENCY, QUALITY, LOCK = range(4)


def times(duration_s: float, rate_hz: float = 100.0) -> NDArray[np.float64]:
    return np.arange(int(duration_s * rate_hz)) / rate_hz


def knee_velocity(phase: NDArray[np.float64]) -> NDArray[np.float64]:
    """rad/s; the second harmonic holds 60 % of the power, the stride 15 %."""
    amplitudes = np.sqrt(2.0 * np.array([0.15, 0.60, 0.20, 0.05]))
    shifts = (0.3, 1.1, 2.0, -0.5)
    return 2.0 * sum(a * np.cos((k + 1) * phase + s) for k, (a, s) in enumerate(zip(amplitudes, shifts, strict=True)))


def with_jerk(velocity: NDArray[np.float64], dt_s: float = DT_S) -> NDArray[np.float64]:
    estimator = TrustedRhythm(velocity.shape[1])
    return np.array([estimator.step(sample, dt_s).jerk for sample in velocity])


@pytest.mark.parametrize("frequency_hz", [0.35, 0.9, 1.7])
@pytest.mark.parametrize("amplitude", [0.2, 2.0, 20.0])
def test_locks_an_exact_period_within_two_and_a_half_cycles_and_a_few_samples(frequency_hz, amplitude):
    phase = 2.0 * np.pi * frequency_hz * times(10.0 / frequency_hz)
    readings = TrustedRhythm(1).run(amplitude * knee_velocity(phase)[:, None], DT_S)
    first = np.argmax(readings[:, LOCK])
    search_spacing_cycles = 0.12 * frequency_hz
    assert 0 < phase[first] / (2.0 * np.pi) <= 2.5 + search_spacing_cycles + 0.01
    assert readings[-1, FREQUENCY] == pytest.approx(2.0 * np.pi * frequency_hz, rel=1e-3)
    assert readings[-1, QUALITY] > 0.99


def test_before_the_lock_nothing_is_claimed():
    readings = TrustedRhythm(1).run(knee_velocity(5.0 * times(4.0))[:, None], DT_S)
    before = readings[: np.argmax(readings[:, LOCK])]
    assert np.all(before[:, [PHASE, QUALITY]] == 0.0)
    candidates = before[before[:, FREQUENCY] > 0.0, FREQUENCY]
    assert candidates[-1] == pytest.approx(5.0, rel=0.02)
    assert before[0, FREQUENCY] == 0.0


def test_stride_is_not_taken_for_step():
    noise = 0.3 * np.random.default_rng(1).standard_normal((6000, 1))
    readings = TrustedRhythm(1).run(knee_velocity(5.5 * times(60.0))[:, None] + noise, DT_S)
    locked = readings[:, LOCK] > 0.0
    assert locked[-1]
    assert np.all(np.abs(readings[locked, FREQUENCY] / 5.5 - 1.0) < 0.1)


def test_phase_is_unwrapped_and_advances_with_the_motion():
    phase = 5.0 * times(40.0)
    readings = TrustedRhythm(1).run(knee_velocity(phase)[:, None], DT_S)
    locked = readings[:, LOCK] > 0.0
    assert np.all(np.diff(readings[locked, PHASE]) > 0.0)
    ahead = readings[1500:, PHASE] - phase[1500:]
    assert np.ptp(ahead) < np.radians(1.0)


def walk_stop_walk() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """20 s of walking, 5 s of standing, 20 s of walking: true phase (rad) and noisy velocity of two knees (rad/s)."""
    walking = np.concatenate([np.ones(2000), np.zeros(500), np.ones(2000)])
    phase = np.cumsum(5.6 * walking) * DT_S
    velocity = np.stack([knee_velocity(phase), knee_velocity(phase + np.pi)], axis=1) * walking[:, None]
    return phase, velocity + 0.05 * np.random.default_rng(3).standard_normal(velocity.shape)


def test_stop_freezes_and_restart_keeps_the_phase_reference():
    phase, velocity = walk_stop_walk()
    readings = TrustedRhythm(2).run(velocity, DT_S)
    standing = readings[2150:2490]
    assert not standing[:, LOCK].any()
    assert np.ptp(standing[:, PHASE]) == 0.0
    assert np.all(standing[:, FREQUENCY] == 0.0)
    again = 2500 + int(np.argmax(readings[2500:, LOCK]))
    assert (phase[again] - phase[2500]) / (2.0 * np.pi) < 3.0
    before = np.exp(1j * (readings[1000:2000, PHASE] - phase[1000:2000])).mean()
    after = np.exp(1j * (readings[3500:, PHASE] - phase[3500:])).mean()
    assert abs(np.angle(after / before)) < np.radians(5.0)
    assert np.all(np.diff(readings[:, PHASE])[again - 1000 : again] >= 0.0)


def test_jerk_is_the_second_derivative_of_velocity_in_lock_and_nothing_otherwise():
    phase, velocity = walk_stop_walk()
    jerk = with_jerk(velocity)
    readings = TrustedRhythm(2).run(velocity, DT_S)
    assert np.all(jerk[readings[:, LOCK] == 0.0] == 0.0)
    fine = knee_velocity(phase[1000:2000, None] + 5.6 * (0.5 * DT_S + np.array([-1e-3, 0.0, 1e-3])))
    true_jerk = np.diff(fine, 2, axis=1)[:, 0] / 1e-6
    assert np.sqrt(np.mean((jerk[1000:2000, 0] - true_jerk) ** 2)) < 0.15 * np.std(true_jerk)


@pytest.mark.parametrize("seed", range(5))
def test_noise_alone_never_locks_for_long(seed):
    noise = np.random.default_rng(seed).standard_normal((12000, 2))
    assert TrustedRhythm(2).run(noise, DT_S)[:, LOCK].mean() < 0.05


def test_sway_too_small_to_be_walking_does_not_lock():
    sway = 0.03 * np.sin(3.0 * times(60.0))[:, None]
    assert not TrustedRhythm(1).run(sway, DT_S)[:, LOCK].any()


@pytest.mark.parametrize("rate_hz", [50.0, 60.0, 128.0])
def test_other_rates_with_jitter_give_the_same_rhythm(rate_hz):
    rng = np.random.default_rng(7)
    estimator = TrustedRhythm(1, TrustedParameters(nominal_interval_s=1.0 / rate_hz))
    time_s = 0.0
    ahead = []
    for _ in range(int(30 * rate_hz)):
        dt_s = (1.0 + 0.2 * rng.uniform(-1.0, 1.0)) / rate_hz
        time_s += dt_s
        reading = estimator.step(knee_velocity(np.array([5.0 * time_s])), dt_s)
        ahead.append(reading.phase - 5.0 * time_s)
    assert reading.locked
    assert reading.frequency == pytest.approx(5.0, rel=0.01)
    assert np.ptp(ahead[len(ahead) // 2 :]) < np.radians(3.0)


def test_short_gap_is_bridged_and_long_gap_ends_the_lock_but_not_the_reference():
    phase = 5.0 * times(60.0)
    velocity = knee_velocity(phase)[:, None]
    estimator = TrustedRhythm(1)
    before = estimator.run(velocity[:2000], DT_S)[-1]
    bridged = estimator.step(velocity[2030], 0.31)
    assert bridged.locked
    assert bridged.phase - before[PHASE] == pytest.approx(phase[2030] - phase[1999], abs=np.radians(3.0))
    estimator.run(velocity[2031:3000], DT_S)
    assert not estimator.step(velocity[3150], 1.51).locked
    late = estimator.run(velocity[3151:], DT_S)
    assert late[-1, LOCK] == 1.0
    shift = (late[-1, PHASE] - phase[-1]) - (before[PHASE] - phase[1999])
    assert abs(np.angle(np.exp(1j * shift))) < np.radians(3.0)


def test_split_and_resume_through_json_text_is_bit_identical():
    _, velocity = walk_stop_walk()
    whole = TrustedRhythm(2)
    expected = [whole.step(sample, DT_S) for sample in velocity]
    for split in (100, 900, 2300, 2600, 3210):
        first = TrustedRhythm(2)
        first.run(velocity[:split], DT_S)
        second = TrustedRhythm(2)
        second.restore(json.loads(json.dumps(first.snapshot())))
        for sample, reading in zip(velocity[split : split + 700], expected[split : split + 700], strict=True):
            resumed = second.step(sample, DT_S)
            assert resumed[:4] == reading[:4]
            assert np.array_equal(resumed.jerk, reading.jerk)


def test_two_interleaved_sessions_equal_each_alone():
    _, velocity = walk_stop_walk()
    alone = [TrustedRhythm(2).run(part, DT_S) for part in (velocity, 0.5 * velocity[::-1])]
    one, two = TrustedRhythm(2), TrustedRhythm(2)
    for i in range(velocity.shape[0]):
        assert one.step(velocity[i], DT_S)[:4] == tuple(alone[0][i])
        assert two.step(0.5 * velocity[-1 - i], DT_S)[:4] == tuple(alone[1][i])


def test_snapshot_of_another_shape_is_refused():
    with pytest.raises(ValueError, match="channels has shape"):
        TrustedRhythm(2).restore(TrustedRhythm(3).snapshot())


def test_extreme_and_unusable_input_leaves_everything_finite():
    rng = np.random.default_rng(11)
    velocity = knee_velocity(5.0 * times(60.0))[:, None] * np.array([1.0, 0.4])
    hit = rng.random(velocity.shape) < 0.02
    velocity[hit] = rng.choice([np.nan, np.inf, -np.inf, 1e300, -1e300, 1e-300, 0.0], hit.sum())
    intervals_s = rng.choice([0.0, -1.0, np.nan, 1e-9, 0.05, 0.3, 1e6], 6000)
    intervals_s[rng.random(6000) < 0.98] = DT_S
    estimator = TrustedRhythm(2)
    for sample, dt_s in zip(velocity, intervals_s, strict=True):
        reading = estimator.step(sample, float(dt_s))
        assert np.isfinite(reading[:3]).all()
        assert np.isfinite(reading.jerk).all()
        assert 0.0 <= reading.quality <= 1.0
    clean = estimator.run(knee_velocity(5.0 * times(60.0))[:, None] * np.array([1.0, 0.4]), DT_S)
    assert clean[-1, LOCK] == 1.0
    assert clean[-1, FREQUENCY] == pytest.approx(5.0, rel=0.01)


def test_lost_samples_do_not_lose_time():
    phase = 5.0 * times(30.0)
    velocity = knee_velocity(phase)[:, None]
    velocity[np.random.default_rng(2).random(velocity.shape[0]) < 0.1] = np.nan
    readings = TrustedRhythm(1).run(velocity, DT_S)
    # The phase is not moved for a lost sample, of which up to three follow each other, and makes up for it after.
    assert np.ptp(readings[1500:, PHASE] - phase[1500:]) < 3 * 5.0 * DT_S + np.radians(2.0)


def test_dead_channel_does_not_matter():
    knee = knee_velocity(5.0 * times(30.0))
    velocity = np.stack([knee, np.zeros_like(knee)], axis=1)
    last = TrustedRhythm(2).run(velocity, DT_S)[-1]
    assert last[LOCK] == LOCKED
    assert last[FREQUENCY] == pytest.approx(5.0, rel=1e-3)


def test_random_motions_are_right_and_never_wrongly_locked():
    """A sample of the benchmark set, signal at least as strong as noise."""
    motions = [motion for motion in map(random_motion, range(64)) if np.std(motion.velocity) >= 0.5]
    assert len(motions) >= 40
    scores = [score_random(motion, TrustedRhythm(1).run(motion.measured, DT_S)) for motion in motions[:40]]
    assert np.mean([score.is_right for score in scores]) >= 0.97
    assert sum(score.wrong_s for score in scores) <= 0.005 * sum(score.locked_s for score in scores)
    assert np.median([score.cycles_to_right for score in scores]) <= 2.0
