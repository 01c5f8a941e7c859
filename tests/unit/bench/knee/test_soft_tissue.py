"""Sliding sensors: angles round the leg, and what a rigid leg and a sliding one tell."""

import numpy as np
import pytest

from services.bench.knee.soft_tissue import LITERAL, OURS, Outcome, Trial, circumferential_angle, run_trial
from services.bench.knee.soft_tissue_board import explain, published_model


def test_the_circumferential_angle_goes_from_the_side_to_the_front():
    normals = np.array([[0.0, 0.0, 1.0], [1.0, 5.0, 0.0], [0.0, 1.0, -1.0], [-1.0, 0.0, 1.0]])
    assert np.degrees(circumferential_angle(normals)) == pytest.approx([0.0, 90.0, 180.0, 45.0])


def test_a_trial_follows_from_its_numbers():
    trial, again = run_trial(3, 1), run_trial(3, 1)
    assert trial.outcomes[OURS].zero_mean_rmse == again.outcomes[OURS].zero_mean_rmse
    assert np.degrees(trial.sliding).min() > 0.5
    assert np.degrees(trial.outcomes[LITERAL].zero_mean_rmse) < 8.0
    assert (np.degrees(trial.outcomes[LITERAL].axis_error) < 50.0).all()


def invented(n: int = 60) -> list[Trial]:
    draw = np.random.default_rng(0)
    trials = []
    for k in range(n):
        sliding, axis = np.radians(draw.uniform(1.0, 6.0, 2)), np.radians(draw.uniform(2.0, 40.0, 2))
        rmse = np.radians(1.0 + 0.05 * np.degrees(sliding[0]) * np.degrees(axis[1]) + 0.01 * draw.standard_normal())
        outcome = Outcome(float(rmse), axis)
        trials.append(Trial(k % 6, np.radians(draw.uniform(0.0, 90.0, 2)), sliding, {OURS: outcome, LITERAL: outcome}))
    return trials


def test_the_published_model_is_found_again():
    model = published_model(invented(), OURS)
    assert [c.estimate for c in model.coefficients] == pytest.approx([1.0, 0.0, 0.0, 0.05], abs=0.02)
    assert model.fixed_r_squared > 0.99


def test_trials_without_a_valid_angle_are_counted_and_left_out():
    trials = invented()
    lost = trials[0]._replace(outcomes=trials[0].outcomes | {OURS: Outcome(np.nan, np.zeros(2))})
    section = explain([lost, *trials[1:]])
    figures = {row.name: row.value for row in section.rows}
    assert figures[f"soft tissue, {OURS}: trials without a valid angle"] == 1
    assert figures[f"soft tissue, {LITERAL}: trials without a valid angle"] == 0
    assert {"explanatory_motion", "explanatory_axis", "explanatory_model_ours"} <= section.charts.keys()
    assert len(section.tables[0].rows) == 6
