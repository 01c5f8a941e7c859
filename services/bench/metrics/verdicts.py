"""Six visits of synthetic patients who truly change, or do not: is what progress says of them right?"""

import math
from collections.abc import Callable, Sequence

import numpy as np

from services.bench.metrics.verdict_cases import (
    REAL,
    UNDECIDED,
    WITHIN,
    Case,
    Judge,
    case_of,
    is_right,
    ours,
    share,
    strides_alone,
    threshold,
    threshold_alone,
)
from services.bench.metrics.verdict_model import ErrorModel, measured_model
from services.bench.metrics.verdict_visits import Told, measured
from services.bench.report import Section, Table
from services.bench.scoreboard import Row, at_least, at_most, informative
from services.progress.rules import Verdict

BASES = {"below 0.4 m/s": 0.34, "0.4 to 0.8 m/s": 0.6, "above 0.8 m/s": 1.0}
"""m/s at the first visit, by the speed band of the threshold."""
GAINS = (0.0, 0.05, 0.12, 0.25, -0.12)
"""m/s that the sixth visit differs from the first; the visits between go there in equal parts."""
VISITS, PATIENTS = 6, 200
DEVELOPMENT, REPORTED = (601, 602), (681, 682)
"""Persons through the chain in each band: the model is measured on the first, its test and all chain figures come from
the second, on whom nothing was chosen. What progress takes as repeated at every visit was chosen on the first and on
persons from 651 on."""
MODEL_GAINS, CHAIN_GAINS = (0.0, 0.0, 0.12, 0.25), (0.0, 0.0, 0.05, 0.12, 0.25)
SLOWEST = 0.05
"""m/s: a drawn day is no slower."""
DRAW_SEED = 20_260
STEPS = len(BASES) * (len(DEVELOPMENT) * len(MODEL_GAINS) + len(REPORTED) * len(CHAIN_GAINS))
NOTE = (
    "verdicts: walking speed of hemiparetic walkers, six visits two weeks apart, thresholds of chronic stroke. Few "
    "persons go through the whole chain, each visit with its own mounting, tape and noise; the 200 patients of each "
    "row are drawn from the errors measured on other persons of the chain, a model tested on the reported ones. "
    "Right: real change where the true change is beyond the threshold and that way, within measurement error where it "
    "is not; cannot tell where the interval of the change, which reaches over the threshold, holds the true change. "
    "Outright: the same with cannot tell never right. Baseline: the threshold against the two values alone"
)


def verdicts_section(advance: Callable[[], None]) -> Section:
    """Chain, model, and patients drawn from it."""
    model = measured_model(_people(DEVELOPMENT, MODEL_GAINS, advance))
    chain = [_chain_cases(visits) for visits in _people(REPORTED, CHAIN_GAINS, advance)]
    walked = [case for cases in chain for case in cases]
    drawn = {band: {gain: drawn_cases(model, base, gain) for gain in GAINS} for band, base in BASES.items()}
    rows = [*_drawn_rows(drawn), *_day_to_day_rows(model), *_chain_rows(walked), *_model_rows(model, walked)]
    return Section("did this patient really change", [NOTE], rows, [_table(drawn)])


def _people(persons: Sequence[int], gains: Sequence[float], advance: Callable[[], None]) -> list[list[Told]]:
    people = []
    for place, base in enumerate(BASES.values()):
        for person in persons:
            visits = []
            for day, gain in enumerate(gains):
                visits.append(measured(person + 10 * place, 100 * (person + 10 * place) + day, base + gain))
                advance()
            people.append(visits)
    return people


def _chain_cases(visits: Sequence[Told]) -> list[Case]:
    """Every later visit against the first."""
    told, base = [each.metric for each in visits], visits[0].speed
    return [case_of(told[:end], base, visits[end - 1].speed - base) for end in range(2, len(visits) + 1)]


def course(base: float, gain: float) -> list[float]:
    """True speeds of the visits, m/s."""
    return [base + gain * number / (VISITS - 1) for number in range(VISITS)]


def drawn_cases(
    model: ErrorModel, base: float, gain: float, patients: int = PATIENTS, day_to_day: float = 0.0
) -> list[Case]:
    """One verdict for each drawn patient. `day_to_day` is the standard deviation of the speed itself, m/s."""
    cases = []
    for patient in range(patients):
        rng = np.random.default_rng([DRAW_SEED, patient, round(1000 * base), round(1000 * abs(gain)), gain < 0])
        speeds = [speed + day_to_day * rng.standard_normal() for speed in course(base, gain)]
        cases.append(case_of(model.draw(rng, [max(SLOWEST, speed) for speed in speeds]), base, gain))
    return cases


def _drawn_rows(drawn: dict[str, dict[float, list[Case]]]) -> list[Row]:
    everybody = [case for courses in drawn.values() for cases in courses.values() for case in cases]
    still = [case for courses in drawn.values() for case in courses[0.0]]
    rows = [
        at_least("verdicts: right, all courses", _right(everybody), "%", 95.0, _right(everybody, threshold_alone)),
        informative("verdicts: right, by a t-test over strides alone", _right(everybody, strides_alone), "%"),
        at_most("verdicts: false real change, nothing changed", _real(still), "%", 5.0, _real(still, threshold_alone)),
        informative("verdicts: false real change by a t-test over strides alone", _real(still, strides_alone), "%"),
        informative("verdicts: right outright", _outright(everybody), "%", _outright(everybody, threshold_alone)),
        informative("verdicts: cannot tell, all courses", _said(everybody, UNDECIDED), "%"),
    ]
    for gain in GAINS:
        cases = [case for courses in drawn.values() for case in courses[gain]]
        name = f"verdicts: right, {gain:+.2f} m/s"
        rows.append(at_least(name, _right(cases), "%", 95.0, _right(cases, threshold_alone)))
    return rows


def _day_to_day_rows(model: ErrorModel) -> list[Row]:
    """Nothing changed, but the person walks each day as differently as the threshold says people do."""
    cases = [
        case
        for base in BASES.values()
        for case in drawn_cases(model, base, 0.0, day_to_day=threshold(base) / (1.96 * math.sqrt(2.0)))
    ]
    name = "verdicts: false real change, nothing changed but the day"
    return [at_most(name, _real(cases), "%", 5.0, _real(cases, threshold_alone))]


def _chain_rows(walked: Sequence[Case]) -> list[Row]:
    still = [case for case in walked if case.true == 0.0]
    return [
        informative("verdicts, chain: number of verdicts", len(walked), ""),
        at_least("verdicts, chain: right", _right(walked), "%", 95.0, _right(walked, threshold_alone)),
        at_most("verdicts, chain: false real change", _real(still), "%", 5.0, _real(still, threshold_alone)),
        informative("verdicts, chain: cannot tell", _said(walked, UNDECIDED), "%"),
        informative(
            "verdicts, chain: intervals that hold the true change", share(walked, lambda case: case.covered), "%"
        ),
    ]


def _model_rows(model: ErrorModel, walked: Sequence[Case]) -> list[Row]:
    """Whether the model errs as the chain does, on persons it was not measured on."""
    found = math.sqrt(sum((case.change - case.true) ** 2 for case in walked) / len(walked))
    squares = sum(model.change_error(case.base, case.base + case.true) ** 2 for case in walked)
    offset, slope = model.mean
    return [
        informative("verdicts, model: offset", 100 * offset, "% of speed"),
        informative("verdicts, model: slope of the offset over speed", 100 * slope, "% of speed per m/s"),
        informative("verdicts, model: offset of a person", 100 * math.sqrt(model.covariance[0][0]), "% of speed"),
        informative("verdicts, model: error of a day", 100 * model.day_sd, "% of speed"),
        informative(
            "verdicts, chain: error of a change, root mean square; baseline: the model's",
            found,
            "m/s",
            math.sqrt(squares / len(walked)),
        ),
    ]


def _right(cases: Sequence[Case], judge: Judge = ours) -> float:
    return share(cases, lambda case: is_right(case, judge))


def _outright(cases: Sequence[Case], judge: Judge = ours) -> float:
    return share(cases, lambda case: judge(case) is not UNDECIDED and is_right(case, judge))


def _real(cases: Sequence[Case], judge: Judge = ours) -> float:
    return share(cases, lambda case: judge(case) is REAL)


def _covered(cases: Sequence[Case]) -> float:
    return share(cases, lambda case: case.covered)


def _said(cases: Sequence[Case], verdict: Verdict) -> float:
    return share(cases, lambda case: case.verdict is verdict)


def _table(drawn: dict[str, dict[float, list[Case]]]) -> Table:
    header = ("band, true change", "MDC", "real", "within", "cannot tell", "right", "MDC alone right", "t-test right")
    lines = []
    for band, courses in drawn.items():
        for gain, cases in courses.items():
            said = [_said(cases, verdict) for verdict in (REAL, WITHIN, UNDECIDED)]
            right = [_right(cases, judge) for judge in (ours, threshold_alone, strides_alone)]
            mdc = f"{cases[0].true_mdc:.2f}"
            lines.append((f"{band}, {gain:+.2f} m/s", mdc, *(f"{each:.1f}" for each in (*said, *right))))
    return Table("verdicts on 200 drawn patients each, %", header, lines)
