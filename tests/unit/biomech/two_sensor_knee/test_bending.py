"""Which way a knee bends where its motion does not show it: what the session declares."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.bench.knee.legs import Sensors, record, seated_flexion, walking
from services.biomech.two_sensor_knee.knee_axis import KneeAxis
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters

RATE_HZ = 100.0
FLEXION, _, VALID = range(3)
LEFT, UP, NOTHING = np.array([0.0, 0.0, -1.0]), np.array([0.0, 1.0, 0.0]), np.zeros((2, 3))
MOUNTINGS = [Rotation.random(2, rng=seed).as_matrix() for seed in range(3)]
STRAPPED = Rotation.from_euler("xyz", [15.0, -15.0, 15.0], degrees=True)
"""How far from its declaration a sensor is put on."""


def seated(R, leftward, upward, motion=None):
    leg = record(motion or seated_flexion(), 20.0, RATE_HZ, Sensors(R))
    estimator = KneeAxis(KneeAxisParameters(sample_delay_s=0.0))
    estimator.declare_mounting(leftward, upward)
    return estimator.run(leg.rate, leg.force, 1.0 / RATE_HZ), leg, estimator


def error_deg(out, leg):
    return np.degrees(np.std(out[-800:, FLEXION] - leg.flexion[-800:]))


@pytest.mark.parametrize("R", MOUNTINGS)
def test_a_declared_left_tells_which_way_a_seated_leg_bends(R):
    out, leg, _ = seated(R, R @ STRAPPED.apply(LEFT), NOTHING)
    assert out[-1, VALID] == 1.0
    assert error_deg(out, leg) < 1.0


@pytest.mark.parametrize("R", MOUNTINGS)
def test_declared_directions_up_both_segments_tell_it_too(R):
    out, leg, _ = seated(R, NOTHING, R @ STRAPPED.apply(UP))
    assert out[-1, VALID] == 1.0
    assert error_deg(out, leg) < 1.0


def test_one_sensor_with_a_declared_left_is_enough():
    R = MOUNTINGS[1]
    leftward = R @ LEFT
    leftward[0] = 0.0
    out, leg, _ = seated(R, leftward, NOTHING)
    assert error_deg(out, leg) < 1.0


def test_declarations_that_contradict_each_other_say_nothing():
    R = MOUNTINGS[0]
    out, _, estimator = seated(R, -(R @ LEFT), R @ UP)
    assert not estimator.reading().is_sign_known
    assert not out[:, VALID].any()


def test_a_left_across_the_axis_says_nothing():
    R = MOUNTINGS[0]
    _, _, estimator = seated(R, R @ np.array([1.0, 0.0, 0.0]), NOTHING)
    assert not estimator.reading().is_sign_known


def test_what_a_walk_shows_is_believed_against_what_was_declared():
    R = MOUNTINGS[2]
    out, leg, _ = seated(R, -(R @ LEFT), NOTHING, walking())
    assert error_deg(out, leg) < 1.0
