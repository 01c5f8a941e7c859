"""The synthetic leg against itself: gravity, rates, mounting."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.bench.knee.legs import GRAVITY, Sensors, cycling, record, seated_flexion, sit_to_stand, walking

MOTIONS = [walking, seated_flexion, cycling, sit_to_stand]


@pytest.mark.parametrize("motion", MOTIONS)
def test_a_leg_at_rest_feels_gravity_and_no_rate(motion):
    leg = record(motion(), 2.0, 100.0)
    assert np.linalg.norm(leg.force, axis=2) == pytest.approx(GRAVITY, abs=1e-6)
    assert np.abs(leg.rate).max() < 1e-9


@pytest.mark.parametrize("motion", MOTIONS)
def test_the_shank_turns_by_flexion_more_than_the_thigh(motion):
    still = motion()._replace(lean=lambda t: 0.0 * t, heading=lambda t: 0.0 * t)
    leg = record(still, 10.0, 100.0)
    relative = (leg.rate[:, 1] - leg.rate[:, 0]) @ np.array([0.0, 0.0, -1.0])
    turned = leg.flexion[0] + np.concatenate([[0.0], np.cumsum(relative[1:]) / 100.0])
    assert turned == pytest.approx(leg.flexion, abs=1e-9)


def test_mounting_turns_the_samples_and_nothing_else():
    R = Rotation.random(2, rng=1).as_matrix()
    plain, mounted = record(walking(), 6.0, 50.0), record(walking(), 6.0, 50.0, Sensors(R))
    assert mounted.rate == pytest.approx(np.einsum("sij,nsj->nsi", R, plain.rate), abs=1e-9)
    assert mounted.force == pytest.approx(np.einsum("sij,nsj->nsi", R, plain.force), abs=1e-5)
    assert mounted.axes == pytest.approx(R @ [0.0, 0.0, -1.0])


def test_bias_and_noise_are_added_as_asked():
    bias = np.array([[0.01, -0.02, 0.03], [0.0, 0.05, 0.0]])
    leg = record(walking(start_s=50.0), 40.0, 100.0, Sensors(gyro_bias=bias, rate_noise=0.01, force_noise=0.2), seed=2)
    assert leg.rate.mean(axis=0) == pytest.approx(bias, abs=1e-3)
    assert leg.rate.std(axis=0) == pytest.approx(0.01, rel=0.05)
    assert leg.force.std(axis=0) == pytest.approx(0.2, rel=0.05)
