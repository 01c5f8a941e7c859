"""The filter of one joint: its measurement, its Jacobian, its step against the textbook's."""

import numpy as np
import pytest

from services.bench.joukov.motions import perfect_samples
from services.biomech.single_joint.ekf import JointSensor, SingleJointEkf, predict_sample

DT_S = 0.01
SENSOR = JointSensor()
RANDOM = np.random.default_rng(0)
STATES = RANDOM.normal(size=(20, 3)) * (1.0, 4.0, 30.0)


def predicted(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    z, H = np.zeros(3), np.zeros((3, 3))
    predict_sample(x, SENSOR.offset_m, z, H)
    return z, H


@pytest.mark.parametrize("x", STATES)
def test_sample_is_what_a_sensor_on_the_link_feels(x):
    assert predicted(x)[0] == pytest.approx(perfect_samples(x[None])[0], abs=1e-12)


def test_hanging_and_level():
    assert predicted(np.zeros(3))[0] == pytest.approx([0.0, -9.81, 0.0])
    assert predicted(np.array([np.pi / 2, 0.0, 0.0]))[0] == pytest.approx([0.0, 0.0, 9.81])


@pytest.mark.parametrize("x", STATES)
def test_jacobian_against_finite_differences(x):
    step = 1e-6 * np.eye(3)
    differences = np.stack([(predicted(x + d)[0] - predicted(x - d)[0]) / 2e-6 for d in step], axis=1)
    assert predicted(x)[1] == pytest.approx(differences, abs=1e-7)


def textbook(x, P, sample, jerk, density):
    """x, P and normalised innovation squared, all rows at once."""
    F = np.array([[1.0, DT_S, DT_S**2 / 2], [0.0, 1.0, DT_S], [0.0, 0.0, 1.0]])
    G = np.array([DT_S**3 / 6, DT_S**2 / 2, DT_S])
    x, P = F @ x + G * jerk, F @ P @ F.T + np.outer(G, G) * density / DT_S
    z, H = predicted(x)
    S = H @ P @ H.T + np.diag(SENSOR.variances)
    K = P @ H.T @ np.linalg.inv(S)
    e = sample - z
    return x + K @ e, (np.eye(3) - K @ H) @ P, e @ np.linalg.inv(S) @ e


def test_steps_as_the_textbook_does():
    ekf = SingleJointEkf(300.0)
    x, P = ekf.x.copy(), ekf.P.copy()
    for i in range(300):
        truth = np.array([np.sin(0.05 * i), 5.0 * np.cos(0.05 * i), -25.0 * np.sin(0.05 * i)])
        sample = perfect_samples(truth[None])[0] + RANDOM.normal(size=3) * (0.5, 2.0, 2.0)
        jerk = -125.0 * np.cos(0.05 * i)
        x, P, surprise = textbook(x, P, sample, jerk, 300.0)
        assert ekf.step(sample, DT_S, jerk) == pytest.approx(surprise, rel=1e-6)
        assert ekf.x == pytest.approx(x, rel=1e-7, abs=1e-9)
        assert pytest.approx(P, rel=1e-6, abs=1e-12) == ekf.P
    assert abs(ekf.x[0] - truth[0]) < 0.1


def test_no_noise_and_the_right_jerk_is_followed_without_lag():
    ekf = SingleJointEkf(10.0, position=0.0)
    for i in range(2000):
        w_t = 5.0 * i * DT_S
        truth = np.array([np.sin(w_t), 5.0 * np.cos(w_t), -25.0 * np.sin(w_t)])
        ekf.step(perfect_samples(truth[None])[0], DT_S, -125.0 * np.cos(w_t - 2.5 * DT_S))
    assert ekf.x == pytest.approx(truth, abs=0.01)


def test_missing_values_are_left_out():
    ekf, without = SingleJointEkf(300.0), SingleJointEkf(300.0)
    for sample in (np.array([1.0, -9.0, 3.0]), np.full(3, np.nan), np.array([np.nan, -9.0, np.inf])):
        surprise = ekf.step(sample, DT_S)
        without.step(np.array([1.0, -9.0, 3.0]), DT_S)
        assert np.isfinite(ekf.x).all()
        assert surprise >= 0.0
    assert np.trace(ekf.P) > np.trace(without.P)
