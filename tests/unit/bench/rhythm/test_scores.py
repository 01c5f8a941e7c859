"""The judge of the rhythm: perfect readings pass, known mistakes are seen."""

import numpy as np
import pytest

from services.bench.rhythm.motions import INTERVAL_S, Motion, gait_motion, random_motion
from services.bench.rhythm.scores import FREQUENCY, LOCKED, PHASE, QUALITY, score_gait, score_random
from services.bench.rhythm.stride_shapes import HARMONICS, StrideShapes


@pytest.fixture(scope="module")
def shapes() -> StrideShapes:
    drawn = np.random.default_rng(0).standard_normal((2, 4, HARMONICS + 1, 2)) @ np.array([1.0, 1.0j])
    return StrideShapes(drawn * 0.3 / np.arange(1, HARMONICS + 2) ** 2)


def perfect(motion: Motion) -> np.ndarray:
    readings = np.ones((motion.phase.size, 4))
    readings[:, PHASE] = motion.phase - 1.0
    readings[:, FREQUENCY] = motion.frequency
    return readings


def test_a_seed_is_a_motion():
    one, two = random_motion(7), random_motion(7)
    assert np.array_equal(one.measured, two.measured)
    assert not np.array_equal(one.measured, random_motion(8).measured)
    assert np.std(one.measured - one.velocity) == pytest.approx(0.5, rel=0.05)


def test_perfect_readings_of_a_random_motion_pass():
    motion = random_motion(3)
    score = score_random(motion, perfect(motion))
    assert score.is_right
    assert score.wrong_s == 0.0
    assert score.cycles_to_right == 0.0
    assert score.phase_rms == pytest.approx(0.0, abs=1e-6)
    assert score.final_ratio == pytest.approx(1.0)


def test_double_frequency_is_wrong_and_named():
    motion = random_motion(3)
    readings = perfect(motion)
    readings[:, [PHASE, FREQUENCY]] *= 2.0
    score = score_random(motion, readings)
    assert not score.is_right
    assert score.wrong_s == pytest.approx(60.0)
    assert score.cycles_to_right == np.inf
    assert score.final_ratio == pytest.approx(2.0)


@pytest.mark.parametrize("scenario", ["plain", "stop", "speed"])
def test_perfect_readings_of_gait_pass(shapes, scenario):
    motion = gait_motion(5, scenario, shapes)
    score = score_gait(motion, perfect(motion))
    assert score.is_right
    assert score.wrong_s == 0.0
    assert score.recovery_cycles == pytest.approx(0.0, abs=0.05)
    assert score.reference_shift == pytest.approx(0.0, abs=1e-6)


def test_stop_is_seen_in_motion_and_score(shapes):
    motion = gait_motion(5, "stop", shapes)
    begin, end = (int(second / INTERVAL_S) for second in motion.event_s)
    assert np.all(motion.velocity[begin + 60 : end - 60] == 0.0)
    readings = perfect(motion)
    assert score_gait(motion, readings).locked_while_standing == 1.0
    again = np.searchsorted(motion.phase, motion.phase[end - 50] + 3.0 * 2.0 * np.pi)
    readings[begin:again, [LOCKED, QUALITY]] = 0.0
    readings[again:, PHASE] += 0.5
    score = score_gait(motion, readings)
    assert score.locked_while_standing == 0.0
    assert score.recovery_cycles == pytest.approx(3.0, abs=0.05)
    assert score.reference_shift == pytest.approx(0.5, abs=0.02)


def test_late_lock_is_counted_in_cycles(shapes):
    motion = gait_motion(5, "plain", shapes)
    readings = perfect(motion)
    late = np.searchsorted(motion.phase, motion.phase[0] + 4.0 * 2.0 * np.pi)
    readings[:late, LOCKED] = 0.0
    assert score_gait(motion, readings).cycles_to_right == pytest.approx(4.0, abs=0.05)
