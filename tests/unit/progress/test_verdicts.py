import math

import numpy as np
import pytest

from services.progress.estimates import Estimate, change, over_trials
from services.progress.measures import measure_of
from services.progress.rules import Direction, RuleCode, Verdict
from services.progress.verdicts import direction, judge

SPEED = measure_of("walking_speed")


def interval(value, half):
    return Estimate(value, value - half, value + half)


@pytest.mark.parametrize(
    ("value", "half", "verdict", "code"),
    [
        (0.14, 0.03, Verdict.REAL_CHANGE, RuleCode.CHANGE_BEYOND_MDC),
        (-0.14, 0.03, Verdict.REAL_CHANGE, RuleCode.CHANGE_BEYOND_MDC),
        (0.105, 0.03, Verdict.REAL_CHANGE, RuleCode.CHANGE_BEYOND_MDC),
        (0.104, 0.03, Verdict.CANNOT_TELL, RuleCode.INTERVAL_REACHES_MDC),
        (0.08, 0.03, Verdict.CANNOT_TELL, RuleCode.INTERVAL_REACHES_MDC),
        (0.06, 0.03, Verdict.WITHIN_MEASUREMENT_ERROR, RuleCode.CHANGE_WITHIN_MDC),
        (-0.06, 0.03, Verdict.WITHIN_MEASUREMENT_ERROR, RuleCode.CHANGE_WITHIN_MDC),
        (0.0, 0.1, Verdict.CANNOT_TELL, RuleCode.OWN_ERROR_NOT_SMALLER),
        (0.5, 0.2, Verdict.CANNOT_TELL, RuleCode.OWN_ERROR_NOT_SMALLER),
    ],
)
def test_the_interval_counts_with_the_threshold(value, half, verdict, code):
    found, rules = judge(SPEED, interval(value, half), 0.1)
    assert found is verdict
    assert [rule.code for rule in rules] == [code]
    assert rules[0].parameters["mdc"] == 0.1


def test_small_changes_of_the_knee_are_no_progress_whatever_a_threshold_says():
    knee = measure_of("knee_flexion_range")
    found, rules = judge(knee, interval(math.radians(5), math.radians(0.5)), math.radians(2))
    assert found is Verdict.WITHIN_MEASUREMENT_ERROR
    assert rules[0].code is RuleCode.BELOW_SMALLEST_CHANGE
    assert judge(knee, interval(math.radians(7), math.radians(0.5)), math.radians(2))[0] is Verdict.REAL_CHANGE


@pytest.mark.parametrize(
    ("name", "before", "after", "way"),
    [
        ("walking_speed", 0.5, 0.7, Direction.BETTER),
        ("walking_speed", 0.7, 0.5, Direction.WORSE),
        ("tug_time", 20.0, 14.0, Direction.BETTER),
        ("step_length_ratio_paretic_to_non_paretic", 0.7, 0.9, Direction.BETTER),
        ("step_length_ratio_paretic_to_non_paretic", 0.9, 1.3, Direction.WORSE),
        ("cadence", 90.0, 120.0, None),
        ("knee_flexion_range", 0.5, 0.9, None),
    ],
)
def test_a_direction_is_said_where_the_measure_has_a_better_side(name, before, after, way):
    assert direction(measure_of(name), before, after) is way


def test_errors_of_both_visits_add_as_independent():
    both = change(interval(0.5, 0.03), interval(0.7, 0.04))
    assert both.value == pytest.approx(0.2)
    assert both.half == pytest.approx(0.05)


def test_what_errs_alike_at_every_visit_drops_out_of_a_change_but_for_its_growth():
    before, after = Estimate(0.5, 0.45, 0.55, repeated=0.04), Estimate(0.75, 0.675, 0.825, repeated=0.06)
    assert before.own == pytest.approx(0.03)
    assert change(before, after).half == pytest.approx(math.hypot(0.03, 0.045, 0.02))
    assert over_trials([before] * 4).repeated == pytest.approx(0.04)


def test_unchanged_people_exceed_both_errors_together_once_in_twenty_times():
    rng = np.random.default_rng(3)
    mdc, half, said = 0.15, 0.06, 0
    for from_day, from_us in rng.standard_normal((4000, 2)):
        change = from_day * mdc / 1.96 + from_us * half / 1.96
        said += judge(SPEED, interval(change, half), mdc)[0] is Verdict.REAL_CHANGE
    assert 0.04 <= said / 4000 <= 0.06


def test_trials_share_their_own_error_and_average_what_they_scatter_beyond_it():
    alike = over_trials([interval(0.5, 0.03)] * 4)
    assert alike.half == pytest.approx(0.03)
    scattered = over_trials([interval(value, 0.001) for value in (0.40, 0.50, 0.60)])
    assert scattered.value == pytest.approx(0.5)
    assert scattered.half == pytest.approx(1.96 * 0.1 / math.sqrt(3), rel=1e-3)
    assert over_trials([interval(0.5, 0.03)]) == interval(0.5, 0.03)
