from dataclasses import replace

import pytest

from schemas.conditions import UNSAID
from schemas.metrics import Doubt, DoubtKind
from schemas.population import Population
from schemas.vocabulary import Task
from services.progress.baseline import freeze
from services.progress.progress import Person, ReferenceUse, progress
from services.progress.rules import RULES, Direction, RuleCode, Verdict
from services.progress.visits import in_visits
from tests.unit.progress.patient import TEN_METRES


def codes(rules):
    return [rule.code for rule in rules]


@pytest.mark.parametrize(
    ("first", "last", "mdc", "verdict"),
    [
        (0.30, 0.45, 0.10, Verdict.REAL_CHANGE),
        (0.30, 0.35, 0.10, Verdict.WITHIN_MEASUREMENT_ERROR),
        (0.40, 0.53, 0.15, Verdict.CANNOT_TELL),
        (0.80, 1.05, 0.15, Verdict.REAL_CHANGE),
        (0.81, 0.93, 0.18, Verdict.WITHIN_MEASUREMENT_ERROR),
        (1.20, 0.90, 0.18, Verdict.REAL_CHANGE),
    ],
)
def test_the_threshold_is_that_of_the_baseline_band(make, first, last, mdc, verdict):
    speed = make.judged(make.speeds(first, 2.0, last))
    assert speed.mdc.value == mdc
    assert speed.mdc.source.startswith("Lewek 2019")
    assert speed.verdict is verdict
    assert speed.change.value == pytest.approx(last - first)
    assert speed.direction is (None if verdict is not Verdict.REAL_CHANGE else
                               Direction.BETTER if last > first else Direction.WORSE)  # fmt: skip


def test_the_band_stays_when_the_patient_leaves_it(make):
    visits = make.speeds(0.38, 0.6, 0.9, 1.2)
    assert [each.verdict for each in make.judged(visits).visits[1:]] == [Verdict.REAL_CHANGE] * 3
    later = make.judged(visits, session="s2")
    assert later.mdc.value == 0.18
    assert later.baseline.visit == 3


def test_thresholds_frozen_once_are_used_for_ever(make):
    visits = make.speeds(0.5, 0.7)
    frozen = freeze(visits, None, Population.STROKE_CHRONIC, {})
    old = frozen.model_dump(mode="json")
    for row in old["tests"][0]["thresholds"]:
        row["value"] = 0.3
    speed = make.judged(visits, baseline=type(frozen).model_validate(old))
    assert speed.mdc.value == 0.3
    assert speed.verdict is Verdict.WITHIN_MEASUREMENT_ERROR


@pytest.mark.parametrize("population", [Population.PARKINSON, Population.STROKE_SUBACUTE, Population.HEALTHY])
def test_no_threshold_is_borrowed_from_other_people(make, population):
    speed = make.judged(make.speeds(0.5, 0.9), person=Person(population, None, {}))
    assert (speed.verdict, speed.mdc) == (Verdict.CANNOT_TELL, None)
    assert speed.rules[0].parameters == {"population": population, "occasion": "between_days"}
    assert speed.change.value == pytest.approx(0.4)


def test_a_population_is_said_and_stays(make):
    visits = make.speeds(0.5, 0.9)
    unknown = make.judged(visits, person=Person(None, None, {}))
    assert codes(unknown.rules) == [RuleCode.POPULATION_UNSAID]
    frozen = freeze(visits, None, Population.STROKE_CHRONIC, {})
    other = make.judged(visits, person=Person(Population.STROKE_SUBACUTE, None, {}), baseline=frozen)
    assert codes(other.rules) == [RuleCode.POPULATION_CHANGED]


@pytest.mark.parametrize(
    ("changes", "what"),
    [
        ({"conditions": {"aid": "cane"}}, "aid"),
        ({"conditions": {"orthosis": "ankle_foot"}}, "orthosis"),
        ({"conditions": {"footwear": "barefoot"}}, "footwear"),
        ({"conditions": {"physical_assistance": True}}, "physical_assistance"),
        ({"sensors": ("pelvis:lateral",)}, "sensors"),
        ({"estimator": "ekf"}, "estimator"),
        ({"walk_path": "straight"}, "walk_path"),
        ({"walkway_m": 10.0}, "walkway_m"),
        ({"leg_length_m": 0.9}, "leg_length_m"),
        ({"leg_length_m": None}, "leg_length_m"),
        ({"lengths_from": "default"}, "lengths_from"),
        ({"software": "ambula 0.2.0"}, "software"),
    ],
)
def test_unlike_trials_are_not_compared_and_the_difference_is_named(make, changes, what):
    fields = dict(changes)
    if "conditions" in fields:
        fields["conditions"] = make.said(**fields["conditions"])
    number = make.metric(0.9)
    if "software" in fields:
        fields = {"metrics": make.results(number, software=fields["software"])}
    visits = in_visits([make.trial("a", 0, make.metric(0.5)), make.trial("b", 14, number, **fields)])
    speed = make.judged(visits)
    assert speed.verdict is Verdict.CANNOT_TELL
    assert codes(speed.rules) == [RuleCode.DIFFERENCE]
    assert speed.rules[0].parameters["what"] == what
    assert speed.rules[0].parameters["now"] != speed.rules[0].parameters["baseline"]
    assert [point.comparable for point in speed.points] == [True, False]


def test_what_nobody_said_cannot_be_the_same(make):
    visits = make.speeds(0.5, 0.9, conditions=UNSAID)
    speed = make.judged(visits)
    assert speed.verdict is Verdict.CANNOT_TELL
    unsaid = [rule.parameters["what"] for rule in speed.rules if rule.code is RuleCode.UNSAID]
    assert unsaid == ["aid", "orthosis", "footwear", "speed_instruction"]
    assert RuleCode.NO_BASELINE in codes(speed.rules)


def test_angles_need_the_same_datum_and_other_measures_do_not(make):
    def of(session, day, datum):
        knee = make.metric(0.6, 0.01, name="knee_flexion_range", side="left", unit="rad")
        return make.trial(session, day, make.metric(0.5), knee, datum=datum)

    visits = in_visits([of("a", 0, "quiet standing"), of("b", 14, "segments vertical")])
    assert make.judged(visits).points[1].comparable
    knee = make.judged(visits, measure="knee_flexion_range", side="left")
    assert [rule.parameters["what"] for rule in knee.rules] == ["datum"]


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"grade": "poor"}, RuleCode.GRADE_TOO_LOW),
        (
            {"value": None, "low": None, "high": None, "grade": "withheld", "withheld_because": "lost"},
            RuleCode.NO_VALUE,
        ),
        ({"low": None, "high": None, "mean_std": None}, RuleCode.NO_INTERVAL),
    ],
)
def test_what_cannot_be_trusted_is_not_compared(make, changes, code):
    visits = in_visits([make.trial("a", 0, make.metric(0.5)), make.trial("b", 14, make.metric(0.9, **changes))])
    speed = make.judged(visits)
    assert (speed.verdict, codes(speed.rules)) == (Verdict.CANNOT_TELL, [code])


def test_a_wide_interval_alone_forbids_nothing_for_that_of_the_change_is_judged(make):
    def doubted(kind):
        doubt = Doubt(kind=kind, value=2.4, limit=2.0, subject=None)
        return make.metric(0.9, 0.12, mean_std=0.005, grade="poor", doubts=[doubt])

    first = make.trial("a", 0, make.metric(0.5, 0.08, mean_std=0.005))
    wide = make.judged(in_visits([first, make.trial("b", 14, doubted(DoubtKind.WIDE_INTERVAL))]))
    assert wide.verdict is Verdict.REAL_CHANGE
    # Half of the variance that is shared is repeated at the next visit, so the change is known better than both values.
    assert wide.change.high - wide.change.value < 0.8 * (0.08**2 + 0.12**2) ** 0.5
    lost = make.judged(in_visits([first, make.trial("b", 14, doubted(DoubtKind.LOSS))]))
    assert codes(lost.rules) == [RuleCode.GRADE_TOO_LOW]


def test_only_what_rests_on_lengths_repeats_its_error(make):
    def of(session, day, value):
        return make.trial(session, day, make.metric(value, 2.0, name="cadence", unit="steps/min", mean_std=0.1))

    cadence = make.judged(in_visits([of("a", 0, 90.0), of("b", 14, 100.0)]), measure="cadence")
    assert cadence.change.half == pytest.approx(2.0 * 2**0.5)


def test_variability_needs_ten_strides(make):
    def of(session, day, strides):
        return make.trial(session, day, make.metric(0.05, 0.01, name="stride_time_cv", unit="1", strides=strides))

    few = make.judged(in_visits([of("a", 0, 30), of("b", 14, 9)]), measure="stride_time_cv")
    assert codes(few.rules) == [RuleCode.TOO_FEW_STRIDES]
    enough = make.judged(in_visits([of("a", 0, 30), of("b", 14, 10)]), measure="stride_time_cv")
    assert codes(enough.rules) == [RuleCode.NO_THRESHOLD]


def test_repeats_within_a_visit_have_their_own_threshold(make):
    said = make.said(**TEN_METRES)

    def walk(session, day, value, hours=0.0):
        number = make.metric(value, 0.01, name="ten_metre_walk_speed")
        return make.trial(session, day, number, hours=hours, task=Task.TEN_METRE_WALK, conditions=said)

    visits = in_visits([walk("a", 0, 0.5), walk("b", 0, 0.64, hours=1), walk("c", 14, 0.66)])
    speed = make.judged(visits, measure="ten_metre_walk_speed")
    assert (speed.mdc.occasion, speed.mdc.value) == ("between_days", 0.15)
    (repeat,) = speed.repeats
    assert (repeat.mdc.occasion, repeat.mdc.value) == ("within_occasion", 0.11)
    assert repeat.verdict is Verdict.REAL_CHANGE
    assert repeat.direction is Direction.BETTER
    assert speed.baseline.sessions == ["a", "b"]
    assert speed.baseline.value == pytest.approx(0.57)


def test_another_version_of_a_reference_set_withholds_the_verdicts_of_its_measures(make):
    visits = make.speeds(0.5, 0.9)
    frozen = freeze(visits, None, Population.STROKE_CHRONIC, {"clinic": "1"})
    uses = {"clinic": ReferenceUse("2", frozenset({"walking_speed"}))}
    changed = make.judged(visits, person=replace(make.person, references=uses), baseline=frozen)
    assert codes(changed.rules) == [RuleCode.REFERENCE_CHANGED]
    others = {"clinic": ReferenceUse("2", frozenset({"cadence"}))}
    same = make.judged(visits, person=replace(make.person, references=others), baseline=frozen)
    assert same.verdict is Verdict.REAL_CHANGE


def test_a_single_visit_says_nothing_of_change(make):
    speed = make.judged(make.speeds(0.5))
    assert (speed.verdict, codes(speed.rules)) == (Verdict.CANNOT_TELL, [RuleCode.BASELINE_ONLY])
    assert (speed.change, speed.trend) == (None, None)


def test_tests_at_another_speed_are_other_tests(make):
    fast = make.said(speed_instruction="fast")
    trials = [make.trial("a", 0, make.metric(0.5)), make.trial("b", 0, make.metric(0.8), hours=1, conditions=fast)]
    found = progress(in_visits(trials), freeze(in_visits(trials), None, make.person.population, {}), make.person)
    assert [(each.instruction, each.baseline.sessions) for each in found.series] == [
        ("comfortable", ["a"]), ("fast", ["b"]),
    ]  # fmt: skip


def test_every_rule_carries_the_parameters_of_the_table(make):
    visits = make.speeds(0.5, 0.52, 0.9, 0.64)
    found = make.judged(visits)
    for rule in (rule for visit in found.visits for rule in visit.rules):
        assert tuple(rule.parameters) == RULES[rule.code]
    assert set(RULES) == set(RuleCode)


def test_the_trend_is_told_beside_and_decides_nothing(make):
    speed = make.judged(make.speeds(0.50, 0.51, 0.52, 0.53))
    assert speed.trend.slope_per_day == pytest.approx(0.01 / 14)
    assert speed.trend.low < speed.trend.slope_per_day < speed.trend.high
    assert (speed.trend.visits, speed.trend.days) == (4, 42.0)
    assert speed.verdict is Verdict.WITHIN_MEASUREMENT_ERROR
