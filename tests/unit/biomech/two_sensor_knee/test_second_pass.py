"""Going back over kept samples with what was found later."""

import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.bench.knee.legs import LegRecording, Sensors, record, walking
from services.biomech.two_sensor_knee.knee_axis import KneeAxis
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters

RATE_HZ = 100.0
DT_S = 1.0 / RATE_HZ
FLEXION, _, VALID = range(3)
WORN = Sensors(
    Rotation.random(2, rng=1).as_matrix(), np.radians([[0.4, -0.3, 0.2], [-0.2, 0.3, -0.4]]), 0.003, 0.1, 0.02
)
LEG = record(walking(), 20.0, RATE_HZ, WORN, seed=5)


def first_pass(leg: LegRecording = LEG) -> tuple[KneeAxis, int]:
    """An estimator whose reading has just become valid, and how many samples that took."""
    whole = KneeAxis(KneeAxisParameters(sample_delay_s=0.0)).run(leg.rate, leg.force, DT_S)
    count = int(np.flatnonzero(whole[:, VALID] > 0.0)[0]) + 1
    estimator = KneeAxis(KneeAxisParameters(sample_delay_s=0.0))
    estimator.run(leg.rate[:count], leg.force[:count], DT_S)
    return estimator, count


def test_the_first_seconds_are_known_in_a_second_pass():
    estimator, count = first_pass()
    before = estimator.reading()
    estimator.rewind(LEG.rate[:count], LEG.force[:count], DT_S)
    out = estimator.run(LEG.rate[:count], LEG.force[:count], DT_S)
    error = np.degrees(out[:, FLEXION] - LEG.flexion[:count])
    assert out[:, VALID].all()
    assert abs(error.mean()) < 2.0
    assert error.std() < 2.0
    assert estimator.reading().flexion == pytest.approx(before.flexion, abs=np.radians(0.5))


def test_nothing_is_learned_twice():
    estimator, count = first_pass()
    axes, arms, axis_std = estimator.axes, estimator.arms, estimator.reading().axis_std
    estimator.rewind(LEG.rate[:count], LEG.force[:count], DT_S)
    estimator.run(LEG.rate[:count], LEG.force[:count], DT_S)
    np.testing.assert_array_equal(estimator.axes, axes)
    np.testing.assert_array_equal(estimator.arms, arms)
    assert estimator.reading().axis_std == axis_std


def test_after_the_second_pass_learning_goes_on():
    once, count = first_pass()
    twice, _ = first_pass()
    twice.rewind(LEG.rate[:count], LEG.force[:count], DT_S)
    twice.run(LEG.rate[:count], LEG.force[:count], DT_S)
    straight_on = once.run(LEG.rate[count:], LEG.force[count:], DT_S)
    gone_back = twice.run(LEG.rate[count:], LEG.force[count:], DT_S)
    np.testing.assert_allclose(gone_back[-500:, FLEXION], straight_on[-500:, FLEXION], atol=np.radians(0.2))
    assert np.linalg.norm(twice.axes - once.axes) < np.radians(0.2)


def test_uneven_intervals_and_an_interruption_change_nothing():
    estimator, count = first_pass()
    intervals_s = np.full(count, DT_S)
    estimator.rewind(LEG.rate[:count], LEG.force[:count], intervals_s)
    other = KneeAxis(KneeAxisParameters(sample_delay_s=0.0))
    other.restore(json.loads(json.dumps(estimator.snapshot())))
    out = estimator.run(LEG.rate[:count], LEG.force[:count], intervals_s)
    for rate, force, expected in zip(LEG.rate[:50], LEG.force[:50], out, strict=False):
        assert other.step(rate, force, DT_S).flexion == expected[FLEXION]


def test_unusable_samples_in_between_are_passed_over():
    rate = LEG.rate.copy()
    rate[400:410, 0, 1] = np.nan
    estimator, count = first_pass(LEG._replace(rate=rate))
    estimator.rewind(rate[:count], LEG.force[:count], DT_S)
    out = estimator.run(rate[:count], LEG.force[:count], DT_S)
    assert np.isfinite(out).all()
    assert not out[400:410, VALID].any()
    assert out[410:, VALID].all()
    assert np.degrees(np.std(out[:400, FLEXION] - LEG.flexion[:400])) < 2.0


def test_there_is_no_going_back_before_an_axis_was_found():
    estimator = KneeAxis()
    estimator.run(LEG.rate[:100], LEG.force[:100], DT_S)
    with pytest.raises(ValueError, match="no axis"):
        estimator.rewind(LEG.rate[:100], LEG.force[:100], DT_S)
