"""The figures of the published tables on tiny inputs whose answers are known, and on one who marches."""

import math
from dataclasses import replace

import numpy as np
import pytest

from services.bench.joukov.marching import (
    BEAT,
    ESTIMATORS,
    LITERAL,
    MODELS,
    OURS,
    OWN_PACE,
    PLAIN,
    Setting,
    Trial,
    Tuning,
    settings,
    tune,
)
from services.bench.joukov.marching_tables import best_ratio, largest_S, mean_ratio
from services.bench.joukov.published_tables import error_table, is_smaller, prediction_table
from services.bench.joukov.regions import (
    BOTTOM,
    QUARTER,
    REGIONS,
    REST,
    TOP,
    WHOLE,
    RegionErrors,
    prediction_errors,
    region_errors,
    regions,
)
from services.bench.joukov.segmentation import (
    TURN,
    boundaries,
    mean_frequency,
    percent_error,
    phase_against,
    segmentation,
    segmented_right,
)


def test_regions_are_split_at_three_quarters_of_the_maximum():
    masks = regions(np.array([0.0, -8.0, 5.9, 6.1, 1.0, -6.0, 2.0, 3.0]))
    assert np.flatnonzero(masks[TOP]).tolist() == [1, 3]
    assert (masks[TOP] ^ masks[BOTTOM]).all()
    assert np.flatnonzero(masks[QUARTER]).tolist() == [1, 3]
    assert (masks[QUARTER] ^ masks[REST]).all()
    assert masks[WHOLE].all()


def test_errors_by_region_are_means_of_both_sides():
    truth = np.zeros((3, 4, 4))
    truth[2, :, :] = np.array([1.0, 10.0, -9.0, 2.0])[:, None]
    estimate = truth.copy()
    estimate[0, [1, 2], 0] += [0.3, 0.5]  # right hip, top
    estimate[1, [0, 3], 2] += [-1.0, 1.0]  # right knee, bottom
    errors = region_errors(estimate, truth)
    assert errors.rmse[TOP, 0] == pytest.approx([0.5 * math.sqrt((0.09 + 0.25) / 2), 0.0])
    assert errors.sd[TOP, 0] == pytest.approx([0.5 * 0.1, 0.0])
    assert errors.rmse[BOTTOM, 1] == pytest.approx([0.0, 0.5])
    assert errors.rmse[WHOLE, 1] == pytest.approx([0.0, 0.5 * math.sqrt(0.5)])


def test_prediction_errors_are_per_axis_and_skip_missing_samples():
    surprise = np.zeros((4, 3, 6))
    surprise[:, 0, :3] = 1.0
    surprise[:, 1, :3] = 3.0
    surprise[:2, 2, 3:] = [[2.0, 0.0, 0.0]]
    surprise[2:, 2, :] = np.nan
    errors = prediction_errors(surprise, [[0, 1], [2]])
    assert errors[0] == pytest.approx([2.0, 0.0])
    assert errors[1] == pytest.approx([0.0, math.sqrt(4.0 / 3.0)])


def test_boundaries_are_where_turns_complete():
    time_s = np.arange(0.0, 5.0, 0.01)
    assert boundaries(time_s, TURN * 0.5 * time_s) == pytest.approx([2.0, 4.0])
    # A phase that runs back a little completes each turn once.
    wobbling = TURN * 0.5 * time_s + 0.3 * np.sin(20.0 * time_s)
    assert len(boundaries(time_s, wobbling)) == 2


def test_repetitions_are_right_with_both_boundaries_and_none_between():
    true_s = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    assert segmented_right(np.array([0.05, 1.09, 1.95, 3.0, 4.0]), true_s).tolist() == [1, 1, 1, 1]
    assert segmented_right(np.array([0.0, 1.11, 2.0, 3.0, 4.0]), true_s).tolist() == [0, 0, 1, 1]
    assert segmented_right(np.array([0.0, 1.0, 1.5, 2.0, 4.0]), true_s).tolist() == [1, 0, 0, 0]


def test_a_phase_is_scored_up_to_one_constant_and_only_while_locked():
    time_s = np.arange(0.0, 20.0, 0.01)
    truth = TURN * time_s + 0.2
    always = np.ones(len(time_s), dtype=np.bool_)
    assert segmentation(time_s, truth + 1.7, always, truth).mean() == 1.0
    assert segmentation(time_s, -(truth + 1.7), always, truth).mean() == 1.0
    assert segmentation(time_s, 2.0 * truth, always, truth).mean() == 0.0
    late = time_s > 10.0
    assert segmentation(time_s, truth, late, truth).mean() == pytest.approx(0.5, abs=0.06)
    assert phase_against(truth + 1.7, truth, late) == pytest.approx(truth)


def test_frequency_is_a_mean_while_locked():
    frequency, locked = np.array([1.0, 2.0, 4.0]), np.array([False, True, True])
    assert mean_frequency(frequency, locked) == 3.0
    assert math.isnan(mean_frequency(frequency, ~locked & locked))
    # The paper's second subject: 1.179 Hz for 1.167.
    assert percent_error(1.179, 1.167) == pytest.approx(-1.03, abs=0.05)


def test_significance_is_paired():
    theirs = np.array([10.0, 20.0, 30.0, 40.0, 50.0, 60.0])
    assert is_smaller(theirs - 1.0, theirs)
    assert not is_smaller(theirs + np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0]), theirs)
    assert not is_smaller(theirs, theirs)


def test_the_largest_S_is_the_last_that_is_small_enough():
    assert largest_S(np.array([0.3, 0.5, 0.9, 0.5, 0.95, 0.99, 1.0, 1.0, 1.0]), 0.6) == pytest.approx(10.0**3.5)
    assert largest_S(np.full(9, 0.9), 0.6) is None


S = 1e3


@pytest.fixture(scope="module")
def marched():
    trial = Trial.of(7011, OWN_PACE)
    runs = {estimator: trial.run(Setting("gravity", estimator, S)) for estimator in ESTIMATORS}
    scores = {Setting("gravity", estimator, S): trial.score(run) for estimator, run in runs.items()}
    return trial, runs, {"one": scores, "two": scores}


def test_who_marches_is_followed_better_with_a_rhythm(marched):
    _, _, people = marched
    for estimator in (LITERAL, OURS):
        score = people["one"][Setting("gravity", estimator, S)]
        assert mean_ratio(people, Setting("gravity", estimator, S))[2] < 0.6
        assert score.segmented.mean() > 0.96
        assert len(score.segmented) > 80
    assert mean_ratio(people, Setting("gravity", PLAIN, S)) == pytest.approx([1.0, 1.0, 1.0])
    assert best_ratio(people, Tuning(S, S, S, S))[2] < 0.6
    plain, ours = (people["one"][Setting("gravity", e, S)].prediction[0] for e in (PLAIN, OURS))
    assert (ours < 0.5 * plain).all()


def test_tables_have_the_published_form(marched):
    lines = error_table(marched[2], "gravity", "S*", S, TOP).markdown()
    assert "Table II at S*" in lines[0]
    assert "EKF hip | EKF knee | literal hip | literal knee | ours hip | ours knee" in lines[2]
    assert sum(line.startswith("| one") for line in lines) == 3
    assert sum("±" in line for line in lines) == 6 + 1
    lines = prediction_table(marched[2], {"gravity": "ours"}, "S*", S).markdown()
    assert sum(line.startswith("| two") for line in lines) == 2


def test_a_score_needs_no_lock(marched):
    trial, runs, people = marched
    run = runs[PLAIN]
    lost = trial.score(replace(run, locked=np.zeros_like(run.locked)))
    assert lost.segmented.sum() == 0.0
    assert math.isnan(lost.frequency)
    assert lost.errors.rmse == pytest.approx(people["one"][Setting("gravity", PLAIN, S)].errors.rmse)


def test_what_is_run_covers_every_table():
    tuning = Tuning(star=1e4, tenth=1e3, agile=1e6, agile_ours=10**5.5)
    own = settings(OWN_PACE, tuning)
    assert len(own) == len(set(own))
    for estimator in ESTIMATORS:
        for S_named in tuning.named.values():
            assert {Setting(model, estimator, S_named) for model in MODELS} <= set(own)
    assert Setting("gravity", OURS, tuning.agile_ours) in own
    assert {setting.estimator for setting in settings(BEAT, tuning)} == {LITERAL, OURS}


def test_S_is_tuned_for_the_plain_filter():
    def errors(spread, acceleration):
        shape = (len(REGIONS), 3, 2)
        return [
            RegionErrors(np.full(shape, acceleration[k]), np.full(shape, spread[k])) for k in range(len(acceleration))
        ]

    plain = errors([3.0, 2.0, 1.5, 1.05, 1.0, 1.005, 1.0, 1.0, 1.0], [9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 5.0])
    ours = errors([1.0] * 9, [9.0, 8.0, 7.0, 6.0, 1.0, 4.0, 3.0, 2.0, 5.0])
    tuning = tune(plain, ours)
    assert (tuning.star, tuning.tenth) == (1e4, 1e3)
    assert tuning.agile == pytest.approx(10**5.5)
    assert tuning.agile_ours == 1e4
    # S*/10 is to be on the curve as well.
    assert tune(ours, ours).star == 1e3
