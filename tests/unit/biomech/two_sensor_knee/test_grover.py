"""The published band, equation by equation."""

import json

import numpy as np
import pytest

from services.biomech.two_sensor_knee.grover import (
    AngleBiasFilter,
    AngleFilter,
    ConventionalKnee,
    GroverParameters,
    PlanarSample,
    SimplifiedKnee,
    bias_by_window,
    constant_part,
    tilt,
)

DT_S = 0.05
PARAMETERS = GroverParameters()


def textbook(F, B, Q, x, P, rate, measured):
    """Figure 3 with matrices."""
    x, P = F @ x + B * rate, F @ P @ F.T + Q
    H = np.zeros((1, len(x)))
    H[0, 0] = 1.0
    K = P @ H.T / (H @ P @ H.T + PARAMETERS.tilt_noise)
    return x + K[:, 0] * (measured - x[0]), (np.eye(len(x)) - K @ H) @ P


def test_two_states_are_the_published_matrices():
    draw = np.random.default_rng(0)
    own = AngleBiasFilter(PARAMETERS)
    F, B, Q = np.array([[1.0, -DT_S], [0.0, 1.0]]), np.array([DT_S, 0.0]), np.diag([1e-4, 1e-6])
    x, P = np.zeros(2), 1000.0 * np.eye(2)
    for rate, measured in draw.normal(0.0, 0.3, (200, 2)):
        own.step(rate, measured, DT_S)
        x, P = textbook(F, B, Q, x, P, rate, measured)
        assert [own.angle, own.bias] == pytest.approx(x, abs=1e-7)


def test_one_state_is_the_published_scalar():
    draw = np.random.default_rng(1)
    own = AngleFilter(PARAMETERS)
    x, P = np.zeros(1), 1000.0 * np.eye(1)
    for rate, measured in draw.normal(0.0, 0.3, (200, 2)):
        own.step(rate, measured, DT_S)
        x, P = textbook(np.eye(1), np.array([DT_S]), np.array([[1e-4]]), x, P, rate, measured)
        assert own.angle == pytest.approx(x[0], abs=1e-9)


def samples(n, thigh_bias, shank_bias):
    t = np.arange(n) * DT_S
    thigh, knee = 0.3 * np.sin(2.0 * t), 0.5 - 0.5 * np.cos(2.0 * t)
    thigh_rate, knee_rate = 0.6 * np.cos(2.0 * t), np.sin(2.0 * t)
    return knee, [
        PlanarSample(*row)
        for row in np.stack(
            [thigh_rate + thigh_bias, thigh, thigh_rate + knee_rate + shank_bias, thigh + knee], axis=1
        ).tolist()
    ]


def test_conventional_filter_finds_angle_and_both_biases():
    knee, rows = samples(3000, 0.02, -0.01)
    estimator = ConventionalKnee()
    angles = np.array([estimator.step(row, DT_S) for row in rows])
    assert np.abs(angles[-200:] - knee[-200:]).max() < 0.06
    assert estimator.thigh.bias == pytest.approx(0.02, abs=0.01)
    # Eq. 16 subtracts both: the knee's own bias is the shank's.
    assert estimator.knee.bias == pytest.approx(-0.01, abs=0.02)


def test_simplified_filter_waits_for_its_biases_and_then_agrees():
    knee, rows = samples(1600, 0.02, -0.01)
    estimator = SimplifiedKnee()
    angles = [estimator.step(row, DT_S) for row in rows]
    assert angles[:1000] == [None] * 1000
    assert estimator.thigh_bias == pytest.approx(0.02, abs=0.01)
    settled = np.array([angle for angle in angles[1100:] if angle is not None])
    assert np.abs(settled - knee[1100:]).max() < 0.06


@pytest.mark.parametrize("kind", [ConventionalKnee, SimplifiedKnee])
@pytest.mark.parametrize("cut", [400, 1200])
def test_an_interrupted_run_goes_on_to_the_bit(kind, cut):
    _, rows = samples(1500, 0.02, -0.01)
    whole, first, second = kind(), kind(), kind()
    expected = [whole.step(row, DT_S) for row in rows]
    told = [first.step(row, DT_S) for row in rows[:cut]]
    second.restore(json.loads(json.dumps(first.snapshot())))
    assert told + [second.step(row, DT_S) for row in rows[cut:]] == expected


def test_angles_near_half_a_turn_do_not_jump_round():
    own = AngleFilter(PARAMETERS)
    own.step(0.0, np.pi - 0.01, DT_S)
    assert own.step(0.0, -np.pi + 0.01, DT_S) == pytest.approx(np.pi, abs=0.02)


def test_the_constant_part_is_the_mean():
    signal = np.random.default_rng(2).normal(0.3, 1.0, (777, 2))
    assert constant_part(signal) == pytest.approx(signal.mean(axis=0))
    assert bias_by_window(signal[:, 0], np.array([10, 777])) == pytest.approx(
        [signal[:10, 0].mean(), signal[:, 0].mean()]
    )


def test_tilt_covers_the_circle():
    assert tilt(0.0, 9.81) == 0.0
    assert tilt(9.81, 0.0) == pytest.approx(np.pi / 2)
    assert tilt(1.0, -1.0) == pytest.approx(0.75 * np.pi)
