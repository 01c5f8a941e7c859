import json
from dataclasses import asdict, replace

import numpy as np
import pytest

from services.bench.metrics import verdicts
from services.bench.metrics.verdict_cases import (
    Case,
    case_of,
    is_right,
    ours,
    share,
    strides_alone,
    threshold,
    threshold_alone,
)
from services.bench.metrics.verdict_model import ErrorModel, measured_model
from services.bench.metrics.verdict_visits import SETTING, Coming, Told, judged
from services.bench.scoreboard import at_least
from services.ingest.synthetic.parameters import WalkParameters
from services.ingest.synthetic.patients.walk import PatientWalk
from services.progress.estimates import Estimate
from services.progress.rules import Verdict
from tests.unit.progress.patient import metric

REAL, WITHIN, UNDECIDED = Verdict.REAL_CHANGE, Verdict.WITHIN_MEASUREMENT_ERROR, Verdict.CANNOT_TELL
QUIET = ErrorModel((0.0, 0.0), ((0.0, 0.0), (0.0, 0.0)), 0.0, (metric(1.0, 0.02, spread=0.05),))


def case(verdict, true, low=-1.0, high=1.0, change=0.0) -> Case:
    before, after = metric(0.5), metric(0.5 + change)
    return Case(verdict, 0.5, true, 0.15, Estimate(change, low, high), 0.15, before, after)


@pytest.mark.parametrize(
    ("found", "right"),
    [
        (case(REAL, 0.2, change=0.2), True), (case(REAL, -0.2, change=0.2), False),
        (case(REAL, 0.1, change=0.2), False),
        (case(WITHIN, 0.1), True), (case(WITHIN, 0.0), True), (case(WITHIN, 0.2), False),
        (case(UNDECIDED, 0.2, 0.1, 0.3), True), (case(UNDECIDED, 0.2, 0.1, 0.19), False),
    ],
)  # fmt: skip
def test_what_a_right_verdict_is(found, right):
    assert is_right(found, ours) is right


def test_nothing_comparable_is_never_right():
    assert not is_right(replace(case(UNDECIDED, 0.0), interval=None), ours)


def test_what_others_would_say_of_the_same_visits():
    assert [threshold_alone(case(UNDECIDED, 0.0, change=change)) for change in (0.16, -0.16, 0.14)] == [
        REAL, REAL, WITHIN,
    ]  # fmt: skip
    scattered = replace(
        case(UNDECIDED, 0.0, change=0.03), before=metric(0.5, spread=0.05), after=metric(0.53, spread=0.05)
    )
    assert strides_alone(scattered) is REAL
    assert strides_alone(replace(scattered, before=metric(0.5, spread=0.3))) is WITHIN


def test_thresholds_are_those_of_the_true_band():
    assert [threshold(base) for base in verdicts.BASES.values()] == [0.10, 0.15, 0.18]


@pytest.mark.parametrize(("gain", "verdict"), [(0.0, WITHIN), (0.05, WITHIN), (0.25, REAL), (-0.25, REAL)])
def test_visits_without_error_are_judged_as_they_were(gain, verdict):
    cases = verdicts.drawn_cases(QUIET, 0.6, gain, patients=3)
    # Figures are written as JSON, which knows no numbers of numpy.
    assert json.dumps(asdict(at_least("right", share(cases, lambda case: is_right(case, ours)), "%", 95.0)))
    for found in cases:
        assert found.verdict is verdict
        assert found.change == pytest.approx(gain)


def test_a_poor_visit_is_told_as_cannot_tell():
    visits = [metric(0.5), metric(0.9, grade="poor")]
    found = case_of(visits, 0.5, 0.4)
    assert (found.verdict, found.interval) == (UNDECIDED, None)
    assert judged(visits).rules[0].code == "grade_too_low"


def test_drawn_patients_err_as_the_model_says():
    model = ErrorModel((0.03, -0.1), ((4e-4, 0.0), (0.0, 1e-2)), 0.02, QUIET.templates)
    rng, errors = np.random.default_rng(7), []
    for _ in range(2000):
        before, after = model.draw(rng, [1.0, 1.25])
        errors.append(after.value - before.value - 0.25)
    assert np.sqrt(np.mean(np.square(errors))) == pytest.approx(model.change_error(1.0, 1.25), rel=0.1)


def test_the_model_is_found_again_on_what_it_drew():
    true = ErrorModel((0.03, -0.1), ((4e-4, 0.0), (0.0, 1e-2)), 0.02, QUIET.templates)
    rng, speeds = np.random.default_rng(5), [0.6, 0.6, 0.72, 0.85]
    people = [[Told(v, m) for v, m in zip(speeds, true.draw(rng, speeds), strict=True)] for _ in range(400)]
    found = measured_model(people)
    assert found.mean == pytest.approx(true.mean, abs=0.02)
    assert found.day_sd == pytest.approx(true.day_sd, rel=0.1)
    assert found.covariance[0][0] == pytest.approx(4e-4, rel=0.4)
    assert found.covariance[1][1] == pytest.approx(1e-2, rel=0.4)


def test_the_same_person_comes_with_other_sensors_and_steps():
    def parameters(day):
        return WalkParameters.parse(f"patient=hemiparetic&speed=0.6&seed={day}&affected=left&{SETTING}")

    monday, friday = Coming(parameters(1), 9), Coming(parameters(2), 9)
    assert monday.lengths == friday.lengths
    assert monday.manner == friday.manner
    assert monday.footfalls.by_side != friday.footfalls.by_side
    assert monday.mounts[0].wobble_phase != friday.mounts[0].wobble_phase
    assert monday.description().anthropometry != friday.description().anthropometry
    same = PatientWalk(parameters(9))
    assert Coming(parameters(9), 9).description() == same.description()
    assert Coming(parameters(9), 9).footfalls.by_side == same.footfalls.by_side
