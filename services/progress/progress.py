"""All that is said of a patient's progress, from visits and baseline."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from schemas.conditions import SpeedInstruction
from schemas.population import Population
from schemas.vocabulary import Side, Task
from services.progress.baseline import Baseline, TestBaseline
from services.progress.curves import CurveVisit, curve_visits
from services.progress.likeness import differences, unsaid
from services.progress.measures import Measure, is_followed, measure_of, place
from services.progress.points import Point, Sitting, point, sitting
from services.progress.recovery import OTHER_MOTIONS, JointRecovery, joint_recovery
from services.progress.rules import Rule, RuleCode, rule
from services.progress.series import Frame, Series, series
from services.progress.visits import Trial, Visit, numbers_of_sessions

Test = tuple[Task, SpeedInstruction | None]
BESIDE_JOINTS = ("walking_speed", *OTHER_MOTIONS)
"""Measures that the words on joints rest on."""


@dataclass(frozen=True, slots=True)
class Progress:
    """Series by measure, joints and curves, of every test that was done."""

    series: list[Series]
    joints: list[JointRecovery]
    curves: list[CurveVisit]


@dataclass(frozen=True, slots=True)
class ReferenceUse:
    """A reference set as far as like with like goes."""

    version: str
    measures: frozenset[str]
    """Measures that it tells anything of."""


@dataclass(frozen=True, slots=True)
class Person:
    """What verdicts have to know of the patient and the site now."""

    population: Population | None
    paretic_side: Side | None
    references: Mapping[str, ReferenceUse]
    """Reference sets that are loaded, by name."""


def progress(
    visits: Sequence[Visit],
    baseline: Baseline | None,
    person: Person,
    task: Task | None = None,
    measures: Collection[str] | None = None,
) -> Progress:
    """Everything, or that of one task, or series of some measures alone."""
    found = [test for test in _tests(visits) if task is None or test[0] is task]
    told = [_of_test(test, visits, baseline, person, measures) for test in found]
    return Progress(
        [each for one in told for each in one.series],
        [each for one in told for each in one.joints],
        [each for one in told for each in one.curves],
    )


def _tests(visits: Sequence[Visit]) -> list[Test]:
    done = (
        (trial.task, trial.conditions.speed_instruction)
        for visit in visits
        for trial in visit.trials
        if trial.metrics is not None
    )
    return list(dict.fromkeys(done))


def _of_test(
    test: Test, visits: Sequence[Visit], baseline: Baseline | None, person: Person, wanted: Collection[str] | None
) -> Progress:
    trials = _trials(test, visits)
    base = None if baseline is None else baseline.test(*test)
    first = None if base is None else next((t for _, t in trials if t.session == base.sessions[0]), None)
    frame = _frame(test, visits, baseline, base if first else None, person)
    sittings = [sitting(visit, trial, first) for visit, trial in trials]

    def told(names: Collection[str] | None) -> list[Series]:
        return [
            series(frame, measure_of(name), side, unit, _points(sittings, measure_of(name), side))
            for name, side, unit in _measures(sittings, names)
        ]

    alike = [] if first is None else _alike(trials, first, frame.start)
    joints = _joints(alike, told(BESIDE_JOINTS), person)
    return Progress(told(wanted), joints, curve_visits(alike))


def _trials(test: Test, visits: Sequence[Visit]) -> list[tuple[Visit, Trial]]:
    task, instruction = test
    return [
        (visit, trial)
        for visit in visits
        for trial in visit.of(task)
        if trial.metrics is not None and trial.conditions.speed_instruction is instruction
    ]


def _measures(sittings: Sequence[Sitting], wanted: Collection[str] | None) -> list[tuple[str, str | None, str]]:
    """Name, side and unit of every measure that any of the trials has, in the order of an answer."""
    found = dict.fromkeys(
        (metric.name, metric.side, metric.unit)
        for each in sittings
        for metric in each.numbers.values()
        if is_followed(metric.name) and (wanted is None or metric.name in wanted)
    )
    return sorted(found, key=lambda each: place(each[0]))


def _points(sittings: Sequence[Sitting], measure: Measure, side: str | None) -> list[Point]:
    told = (point(each, measure, side) for each in sittings)
    return [each for each in told if each is not None]


def _frame(
    test: Test, visits: Sequence[Visit], baseline: Baseline | None, base: TestBaseline | None, person: Person
) -> Frame:
    task, instruction = test
    if baseline is None or base is None:
        return Frame(task, instruction, (), 0, None, (), None, (), {})
    start = numbers_of_sessions(visits)[base.sessions[0]]
    population, outdated = baseline.population, _outdated(baseline, person)
    blocked = _blocked(baseline, person)
    return Frame(task, instruction, base.sessions, start, base.speed, base.thresholds, population, blocked, outdated)


def _blocked(baseline: Baseline, person: Person) -> list[Rule]:
    """Why thresholds may not be used at all (rule 6.3.3)."""
    if baseline.population is None:
        return [rule(RuleCode.POPULATION_UNSAID)]
    if person.population is not baseline.population:
        return [rule(RuleCode.POPULATION_CHANGED, person.population, baseline.population)]
    return []


def _outdated(baseline: Baseline, person: Person) -> dict[str, Rule]:
    """Measures whose reference set has another version than at the baseline (rule 6.3.6)."""
    outdated: dict[str, Rule] = {}
    for name, then in baseline.references.items():
        now = person.references.get(name)
        if now is not None and now.version != then:
            changed = rule(RuleCode.REFERENCE_CHANGED, name, now.version, then)
            outdated |= dict.fromkeys(now.measures, changed)
    return outdated


def _alike(trials: Sequence[tuple[Visit, Trial]], first: Trial, start: int) -> list[tuple[Visit, list[Trial]]]:
    """Visits from the baseline on, with their trials that are like its first one."""
    alike: dict[int, tuple[Visit, list[Trial]]] = {}
    for visit, trial in trials:
        if visit.number >= start and not unsaid(trial) and not differences(trial, first, "rad"):
            alike.setdefault(visit.number, (visit, []))[1].append(trial)
    return list(alike.values())


def _joints(
    alike: Sequence[tuple[Visit, Sequence[Trial]]], found: Sequence[Series], person: Person
) -> list[JointRecovery]:
    names = dict.fromkeys(
        side.joint for _, trials in alike for trial in trials if trial.metrics for side in trial.metrics.sides
    )
    speed = next((each for each in found if each.measure == "walking_speed"), None)
    others = [each for each in found if each.measure in OTHER_MOTIONS and _counts(each.side, person.paretic_side)]
    told = [joint_recovery(joint, alike, speed, others) for joint in names]
    return [each for each in told if each is not None]


def _counts(side: str | None, paretic: Side | None) -> bool:
    return side is None or paretic is None or side == paretic
