"""What progress counts from: chosen or first usable, and frozen with the thresholds that fitted then."""

from collections.abc import Iterator, Mapping, Sequence

from pydantic import Field

from schemas.conditions import SpeedInstruction
from schemas.payload import Payload
from schemas.population import Population
from schemas.vocabulary import Task
from services.progress.likeness import differences, unsaid
from services.progress.measures import is_followed
from services.progress.thresholds import TABLE_VERSION, THRESHOLDS, Occasion, Threshold, in_band, usable
from services.progress.trusted import is_trusted
from services.progress.visits import Trial, Visit, numbers_of_sessions

_SPEED_FROM = ((Task.TEN_METRE_WALK, "ten_metre_walk_speed"), (Task.TEN_METRE_WALK, "walking_speed"),
               (Task.WALK, "walking_speed"))  # fmt: skip
"""Where the comfortable speed of a visit comes from, best first."""


class FrozenThreshold(Payload):
    """A threshold as it was chosen; it stays when the table changes."""

    key: str
    measure: str
    occasion: Occasion
    value: float = Field(gt=0, description="in `unit`: minimal detectable change")
    unit: str
    people: str = Field(description="on whom it was measured")
    protocol: str
    above: float | None = Field(description="m/s: baseline speeds it is for; null: open")
    below: float | None = Field(description="m/s: baseline speeds it is for; null: open")
    source: str


class TestBaseline(Payload):
    """One test, at one speed instruction: the sessions that later ones are compared with."""

    __test__ = False

    task: Task
    instruction: SpeedInstruction | None
    sessions: list[str] = Field(min_length=1, description="trials of one visit that are alike, in order")
    speed: float | None = Field(description="m/s, comfortable walking speed at that visit; null: not measured")
    thresholds: list[FrozenThreshold]


class Baseline(Payload):
    """The visit that progress counts from. Tests that it lacks join at the first later visit that has them."""

    session: str = Field(description="of the visit it starts from")
    chosen: bool = Field(description="by somebody; else it is the first usable visit")
    population: Population | None = Field(description="whose thresholds were taken; null: was not known")
    table: str = Field(description="version of the table of thresholds")
    references: dict[str, str] = Field(description="version of each reference set then")
    tests: list[TestBaseline]

    def test(self, task: Task, instruction: SpeedInstruction | None) -> TestBaseline | None:
        """Where one test counts from; null while it was not done."""
        return next((each for each in self.tests if (each.task, each.instruction) == (task, instruction)), None)


def is_usable(trial: Trial) -> bool:
    """Whether later trials can be compared with this one: final, said how it was done, and something to be trusted."""
    if trial.metrics is None or unsaid(trial):
        return False
    return any(
        is_followed(metric.name) and metric.value is not None and is_trusted(metric) for metric in trial.metrics.metrics
    )


def freeze(
    visits: Sequence[Visit], session: str | None, population: Population | None, references: Mapping[str, str]
) -> Baseline | None:
    """The baseline of a patient, counted from the visit of `session`, else from the first usable one.

    Null where that visit, or any at all, is not usable.
    """
    start = 1 if session is None else numbers_of_sessions(visits)[session]
    candidates = [visit for visit in visits if visit.number == start or (session is None and visit.number > start)]
    first = next((trial for visit in candidates for trial in visit.trials if is_usable(trial)), None)
    if first is None:
        return None
    frozen = Baseline(
        session=session or first.session,
        chosen=session is not None,
        population=population,
        table=TABLE_VERSION,
        references=dict(references),
        tests=[],
    )
    return complete(frozen, visits, population)


def complete(baseline: Baseline, visits: Sequence[Visit], population: Population | None) -> Baseline:
    """The baseline with tests that have come since. What is frozen stays; only a population that was not known then
    is filled in, with its thresholds, for the speed of then."""
    known = baseline.population or population
    tests = [
        test
        if baseline.population is not None
        else test.model_copy(update={"thresholds": _choose(test.task, test.instruction, test.speed, known)})
        for test in baseline.tests
    ]
    numbers = numbers_of_sessions(visits)
    start = numbers.get(baseline.session, 1)
    for visit in (visit for visit in visits if visit.number >= start):
        for first in _new_tests(visit, tests):
            tests.append(_test_baseline(first, visit, visits, start, known))
    return baseline.model_copy(update={"population": known, "tests": tests})


def _new_tests(visit: Visit, tests: Sequence[TestBaseline]) -> list[Trial]:
    had = {(each.task, each.instruction) for each in tests}
    firsts: dict[tuple[Task, SpeedInstruction | None], Trial] = {}
    for trial in visit.trials:
        key = (trial.task, trial.conditions.speed_instruction)
        if key not in had and is_usable(trial):
            firsts.setdefault(key, trial)
    return list(firsts.values())


def _test_baseline(
    first: Trial, visit: Visit, visits: Sequence[Visit], start: int, population: Population | None
) -> TestBaseline:
    task, instruction = first.task, first.conditions.speed_instruction
    alike = [
        trial.session
        for trial in visit.of(task)
        if is_usable(trial)
        and trial.conditions.speed_instruction is instruction
        and not differences(trial, first, unit="rad")
    ]
    speeds = (comfortable_speed(each) for each in (visit, *_from_visit(visits, start)))
    speed = next((speed for speed in speeds if speed is not None), None)
    return TestBaseline(
        task=task,
        instruction=instruction,
        sessions=alike,
        speed=speed,
        thresholds=_choose(task, instruction, speed, population),
    )


def _from_visit(visits: Sequence[Visit], number: int) -> Iterator[Visit]:
    return (visit for visit in visits if visit.number == number)


def comfortable_speed(visit: Visit) -> float | None:
    """m/s: mean over the visit's trials at comfortable speed, of the best test that tells it; null where none does."""
    for task, name in _SPEED_FROM:
        metrics = [
            trial.metric(name, None)
            for trial in visit.of(task)
            if trial.conditions.speed_instruction is SpeedInstruction.COMFORTABLE
        ]
        trusted = [each for each in metrics if each is not None and is_trusted(each)]
        speeds = [each.value for each in trusted if each.value is not None]
        if speeds:
            return sum(speeds) / len(speeds)
    return None


def _choose(
    task: Task, instruction: SpeedInstruction | None, speed: float | None, population: Population | None
) -> list[FrozenThreshold]:
    if population is None:
        return []
    chosen: list[FrozenThreshold] = []
    for measure in dict.fromkeys(name for row in THRESHOLDS for name in row.measures):
        for occasion in (Occasion.BETWEEN_DAYS, Occasion.WITHIN_OCCASION):
            row = in_band(usable(measure, task, occasion, population, instruction), speed)
            if row is not None:
                chosen.append(_frozen(row, measure))
    return chosen


def _frozen(row: Threshold, measure: str) -> FrozenThreshold:
    return FrozenThreshold(
        key=row.key,
        measure=measure,
        occasion=row.occasion,
        value=row.value,
        unit=row.unit,
        people=row.people,
        protocol=row.protocol,
        above=None if row.band is None else row.band.above,
        below=None if row.band is None else row.band.below,
        source=row.source,
    )
