"""The published oscillator: its equations, its convergence where it converges, and its state."""

import json

import numpy as np
import pytest

from services.biomech.rhythm.joukov import JoukovOscillator
from services.biomech.rhythm.parameters import JoukovParameters

DT_S = 0.01


def test_first_steps_follow_the_equations_by_hand():
    parameters = JoukovParameters(harmonics=2, initial_frequency=4.0, frequency_rate=0.7, coefficient_rate=0.2)
    oscillator = JoukovOscillator(2, parameters)
    phase, frequency = 0.0, 4.0
    alpha, beta = np.zeros((2, 2)), np.zeros((2, 2))
    order = np.arange(1, 3)
    for velocity in np.array([[1.0, -0.5], [2.0, 0.3], [-1.5, 0.8], [0.4, 0.1]]):
        reading = oscillator.step(velocity, DT_S)
        assert reading.phase == pytest.approx(phase, abs=1e-15)
        assert reading.frequency == pytest.approx(frequency)
        cosine, sine = np.cos(order * phase), np.sin(order * phase)
        error = velocity - alpha @ cosine - beta @ sine
        alpha += 0.2 * DT_S * np.outer(error, cosine)
        beta += 0.2 * DT_S * np.outer(error, sine)
        feedback = 0.7 * error[0] * np.sin(phase)
        phase, frequency = phase + DT_S * (frequency - feedback), frequency - DT_S * feedback
        cosine, sine = np.cos(order * phase), np.sin(order * phase)
        jerk = -(alpha @ (order**2 * cosine) + beta @ (order**2 * sine)) * frequency**2
        assert reading.jerk == pytest.approx(jerk)


def test_learns_a_cosine_it_starts_close_to():
    time_s = np.arange(12000) * DT_S
    velocity = 2.0 * np.cos(5.5 * time_s)[:, None]
    readings = JoukovOscillator(1, JoukovParameters(coefficient_rate=0.2)).run(velocity, DT_S)
    assert readings[-1, 1] == pytest.approx(5.5, rel=0.02)
    assert readings[-1, 2] > 0.9


def test_only_the_driver_turns_the_phase():
    time_s = np.arange(3000) * DT_S
    velocity = np.stack([np.cos(5.0 * time_s), 3.0 * np.sin(8.0 * time_s)], axis=1)
    both = JoukovOscillator(2).run(velocity, DT_S)
    alone = JoukovOscillator(1).run(velocity[:, :1], DT_S)
    other = JoukovOscillator(2, JoukovParameters(driver=1)).run(velocity, DT_S)
    assert np.array_equal(both[:, :2], alone[:, :2])
    assert not np.allclose(other[:, 1], alone[:, 1])


def test_driver_outside_the_channels_is_refused():
    with pytest.raises(ValueError, match="driver 2 is none of the 2 channels"):
        JoukovOscillator(2, JoukovParameters(driver=2))


def test_split_and_resume_through_json_text_is_bit_identical():
    velocity = np.random.default_rng(0).standard_normal((600, 2))
    whole, first, second = JoukovOscillator(2), JoukovOscillator(2), JoukovOscillator(2)
    expected = [whole.step(sample, DT_S) for sample in velocity]
    first.run(velocity[:300], DT_S)
    second.restore(json.loads(json.dumps(first.snapshot())))
    for sample, reading in zip(velocity[300:], expected[300:], strict=True):
        resumed = second.step(sample, DT_S)
        assert resumed[:4] == reading[:4]
        assert np.array_equal(resumed.jerk, reading.jerk)


def test_snapshot_of_another_shape_is_refused():
    with pytest.raises(ValueError, match="this one needs"):
        JoukovOscillator(2).restore(JoukovOscillator(1).snapshot())


def test_extreme_input_leaves_everything_finite():
    rng = np.random.default_rng(5)
    oscillator = JoukovOscillator(2)
    for _ in range(5000):
        sample = rng.choice([np.nan, np.inf, -np.inf, 1e300, 0.0, 1.0, -80.0], 2)
        reading = oscillator.step(sample, float(rng.choice([0.01, 0.0, -1.0, 0.05])))
        assert np.isfinite(reading[:3]).all()
        assert np.isfinite(reading.jerk).all()
