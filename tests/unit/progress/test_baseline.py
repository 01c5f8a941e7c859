import pytest

from schemas.conditions import UNSAID
from schemas.population import Population
from schemas.vocabulary import Task
from services.progress.baseline import Baseline, comfortable_speed, complete, freeze
from services.progress.visits import in_visits

CHRONIC = Population.STROKE_CHRONIC


def test_the_first_usable_visit_is_the_baseline(make):
    visits = in_visits(
        [
            make.trial("unsaid", 0, make.metric(0.5), conditions=UNSAID),
            make.trial("poor", 7, make.metric(0.5, grade="poor")),
            make.trial("running", 14, metrics=None),
            make.trial("good", 21, make.metric(0.5)),
        ]
    )
    frozen = freeze(visits, None, CHRONIC, {"clinic": "1"})
    assert (frozen.session, frozen.chosen, frozen.references) == ("good", False, {"clinic": "1"})
    assert freeze(visits[:3], None, CHRONIC, {}) is None
    assert freeze([], None, CHRONIC, {}) is None


def test_a_chosen_visit_counts_even_when_earlier_ones_could(make):
    frozen = freeze(make.speeds(0.3, 0.5, 0.9), "s1", CHRONIC, {})
    assert (frozen.session, frozen.chosen, frozen.tests[0].sessions) == ("s1", True, ["s1"])
    assert frozen.tests[0].thresholds[0].key == "lewek_2019_comfortable_speed_middle"


def test_a_visit_that_cannot_count_cannot_be_chosen(make):
    trials = [make.trial("unsaid", 0, make.metric(0.5), conditions=UNSAID), make.trial("good", 14, make.metric(0.5))]
    assert freeze(in_visits(trials), "unsaid", CHRONIC, {}) is None
    assert freeze(in_visits(trials), "good", CHRONIC, {}).session == "good"


def test_a_test_that_comes_later_joins_and_changes_nothing_else(make):
    walk = make.trial("walk", 0, make.metric(0.5))
    tug = make.trial("tug", 14, make.metric(20.0, 0.5, name="tug_time", unit="s"), task=Task.TIMED_UP_AND_GO,
                     walkway_m=3.0)  # fmt: skip
    first = freeze(in_visits([walk]), None, CHRONIC, {})
    whole = complete(first, in_visits([walk, tug]), CHRONIC)
    assert whole.tests[0] == first.tests[0]
    assert (whole.tests[1].task, whole.tests[1].sessions, whole.tests[1].speed) == (Task.TIMED_UP_AND_GO, ["tug"], 0.5)
    assert complete(whole, in_visits([walk, tug]), CHRONIC) == whole


def test_a_population_that_is_said_later_is_filled_in_for_the_speed_of_then(make):
    visits = make.speeds(0.3, 0.9)
    unknown = freeze(visits, None, None, {})
    assert (unknown.population, unknown.tests[0].thresholds) == (None, [])
    known = complete(unknown, visits, CHRONIC)
    assert known.population is CHRONIC
    assert known.tests[0].thresholds[0].value == 0.1
    assert complete(known, visits, Population.PARKINSON) == known


def test_trials_of_the_visit_that_differ_are_no_part_of_the_baseline(make):
    trials = [
        make.trial("a", 0, make.metric(0.5)),
        make.trial("cane", 0, make.metric(0.7), hours=1, conditions=make.said(aid="cane")),
        make.trial("b", 0, make.metric(0.52), hours=2),
    ]
    assert freeze(in_visits(trials), None, CHRONIC, {}).tests[0].sessions == ["a", "b"]


def test_the_comfortable_speed_is_that_of_the_best_test(make):
    fast = make.said(speed_instruction="fast")
    ten = make.trial("ten", 0, make.metric(0.6, name="ten_metre_walk_speed"), task=Task.TEN_METRE_WALK, hours=1)
    (visit,) = in_visits([make.trial("walk", 0, make.metric(0.5)), ten])
    assert comfortable_speed(visit) == 0.6
    (only_fast,) = in_visits([make.trial("walk", 0, make.metric(0.9), conditions=fast)])
    assert comfortable_speed(only_fast) is None


def test_it_is_kept_as_plain_values(make):
    frozen = freeze(make.speeds(0.5), None, CHRONIC, {})
    assert Baseline.model_validate(frozen.model_dump(mode="json")) == frozen


def test_an_unknown_session_is_a_bug(make):
    with pytest.raises(KeyError):
        freeze(make.speeds(0.5), "somebody_else", CHRONIC, {})
