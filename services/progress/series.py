"""One measure of one test over the visits: points, baseline, changes, verdict."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date

from schemas.conditions import SpeedInstruction
from schemas.population import Population
from schemas.vocabulary import Task
from services.progress.baseline import FrozenThreshold
from services.progress.estimates import Estimate, change, over_trials
from services.progress.measures import Better, Measure
from services.progress.points import Point
from services.progress.rules import Direction, Rule, RuleCode, Verdict, rule
from services.progress.thresholds import Occasion, usable
from services.progress.trend import Trend, trend
from services.progress.verdicts import direction, judge


@dataclass(frozen=True, slots=True)
class VisitValue:
    """A measure at one visit: the mean of its comparable trials, and the change since the baseline."""

    visit: int
    day: date
    sessions: list[str]
    value: float
    low: float
    high: float
    change: Estimate | None
    verdict: Verdict
    direction: Direction | None
    rules: list[Rule]
    repeated: float
    """Of half the interval, what errs alike at every like visit."""


@dataclass(frozen=True, slots=True)
class Repeat:
    """The last against the first comparable trial of one visit."""

    visit: int
    first: str
    last: str
    change: Estimate
    mdc: FrozenThreshold | None
    verdict: Verdict
    direction: Direction | None
    rules: list[Rule]


@dataclass(frozen=True, slots=True)
class Series:
    """Everything that is said of one measure of one test. `verdict` is that of the newest visit with that test."""

    task: Task
    instruction: SpeedInstruction | None
    measure: str
    side: str | None
    unit: str
    better: Better | None
    points: list[Point]
    visits: list[VisitValue]
    baseline: VisitValue | None
    mdc: FrozenThreshold | None
    change: Estimate | None
    verdict: Verdict
    direction: Direction | None
    rules: list[Rule]
    repeats: list[Repeat]
    trend: Trend | None


@dataclass(frozen=True, slots=True)
class Frame:
    """What the series of one test share. `blocked` is why no threshold may be used, whatever the values."""

    task: Task
    instruction: SpeedInstruction | None
    sessions: Sequence[str]
    """Of the baseline; empty: there is none."""
    start: int
    """Number of the baseline's visit; 0: there is none."""
    speed: float | None
    """m/s, of the baseline."""
    thresholds: Sequence[FrozenThreshold]
    population: Population | None
    blocked: Sequence[Rule]
    outdated: Mapping[str, Rule]
    """Measure -> that its reference set is another version than at the baseline."""

    def threshold(self, measure: str, occasion: Occasion) -> FrozenThreshold | None:
        """The frozen one for a measure."""
        found = (row for row in self.thresholds if row.measure == measure and row.occasion is occasion)
        return next(found, None)


def series(frame: Frame, measure: Measure, side: str | None, unit: str, points: list[Point]) -> Series:
    """The series of one measure from its points, which are in order."""
    mdc = frame.threshold(measure.name, Occasion.BETWEEN_DAYS)
    blocked = _blocked(frame, measure, mdc, Occasion.BETWEEN_DAYS)
    base = _baseline(frame, points)
    later = [] if base is None else _later(frame, measure, points, base, mdc, blocked)
    known = [] if base is None else [base, *later]
    verdict, way, rules, newest = _newest(frame, points, base, later)
    return Series(
        task=frame.task,
        instruction=frame.instruction,
        measure=measure.name,
        side=side,
        unit=unit,
        better=measure.better,
        points=points,
        visits=known,
        baseline=base,
        mdc=mdc,
        change=newest,
        verdict=verdict,
        direction=way,
        rules=rules,
        repeats=_repeats(frame, measure, points),
        trend=trend([float((each.day - known[0].day).days) for each in known], [_estimate(each) for each in known])
        if known
        else None,
    )


def _estimate(visit: VisitValue) -> Estimate:
    return Estimate(visit.value, visit.low, visit.high, visit.repeated)


def _blocked(frame: Frame, measure: Measure, mdc: FrozenThreshold | None, occasion: Occasion) -> list[Rule]:
    """Why no threshold may be used, whatever the values."""
    blocked = list(frame.blocked)
    if measure.name in frame.outdated:
        blocked.append(frame.outdated[measure.name])
    if mdc is None and frame.population is not None and not frame.blocked:
        banded = usable(measure.name, frame.task, occasion, frame.population, frame.instruction)
        needs_speed = frame.speed is None and banded
        blocked.append(
            rule(RuleCode.NO_BASELINE_SPEED, frame.start)
            if needs_speed
            else rule(RuleCode.NO_THRESHOLD, frame.population, occasion)
        )
    return blocked


def _baseline(frame: Frame, points: Sequence[Point]) -> VisitValue | None:
    alike = [point for point in points if point.comparable and point.session in frame.sessions]
    if not alike:
        return None
    only = [rule(RuleCode.BASELINE_ONLY, frame.start)]
    return _value(alike, None, Verdict.CANNOT_TELL, None, only)


def _value(
    points: Sequence[Point], since: Estimate | None, verdict: Verdict, way: Direction | None, rules: list[Rule]
) -> VisitValue:
    mean = over_trials([point.estimate for point in points])
    sessions = [point.session for point in points]
    first = points[0]
    how = since, verdict, way, rules
    return VisitValue(first.visit, first.day, sessions, mean.value, mean.low, mean.high, *how, mean.repeated)


def _later(
    frame: Frame,
    measure: Measure,
    points: Sequence[Point],
    base: VisitValue,
    mdc: FrozenThreshold | None,
    blocked: list[Rule],
) -> list[VisitValue]:
    numbers = sorted({point.visit for point in points if point.comparable and point.visit > frame.start})
    values = []
    for number in numbers:
        alike = [point for point in points if point.comparable and point.visit == number]
        after = over_trials([point.estimate for point in alike])
        since = change(_estimate(base), after)
        verdict, way, rules = _judged(measure, base.value, after.value, since, mdc, blocked)
        values.append(_value(alike, since, verdict, way, rules))
    return values


def _judged(
    measure: Measure, before: float, after: float, since: Estimate, mdc: FrozenThreshold | None, blocked: list[Rule]
) -> tuple[Verdict, Direction | None, list[Rule]]:
    if mdc is None or blocked:
        return Verdict.CANNOT_TELL, None, [*blocked, *_below_smallest(measure, since)]
    verdict, rules = judge(measure, since, mdc.value)
    return verdict, direction(measure, before, after) if verdict is Verdict.REAL_CHANGE else None, rules


def _below_smallest(measure: Measure, since: Estimate) -> list[Rule]:
    if measure.smallest_change is None or abs(since.value) >= measure.smallest_change:
        return []
    return [rule(RuleCode.BELOW_SMALLEST_CHANGE, since.value, measure.smallest_change)]


def _newest(
    frame: Frame, points: Sequence[Point], base: VisitValue | None, later: Sequence[VisitValue]
) -> tuple[Verdict, Direction | None, list[Rule], Estimate | None]:
    """Verdict on the newest visit with that test; where nothing of it is comparable, why."""
    last = points[-1].visit
    if not frame.sessions:
        return Verdict.CANNOT_TELL, None, [rule(RuleCode.NO_BASELINE), *_reasons(points, last)], None
    if base is None:
        reasons = [rule(RuleCode.NO_BASELINE_VALUE, frame.start), *_reasons(points, frame.start)]
        return Verdict.CANNOT_TELL, None, reasons, None
    if last <= frame.start:
        return Verdict.CANNOT_TELL, None, base.rules, None
    if later and later[-1].visit == last:
        return later[-1].verdict, later[-1].direction, later[-1].rules, later[-1].change
    return Verdict.CANNOT_TELL, None, _reasons(points, last), None


def _reasons(points: Sequence[Point], visit: int) -> list[Rule]:
    """Each reason once, of all points of a visit."""
    found = [each for point in points if point.visit == visit for each in point.rules]
    return [each for place, each in enumerate(found) if each not in found[:place]]


def _repeats(frame: Frame, measure: Measure, points: Sequence[Point]) -> list[Repeat]:
    mdc = frame.threshold(measure.name, Occasion.WITHIN_OCCASION)
    blocked = _blocked(frame, measure, mdc, Occasion.WITHIN_OCCASION)
    repeats = []
    for number in sorted({point.visit for point in points if frame.sessions}):
        alike = [point for point in points if point.comparable and point.visit == number]
        if len(alike) < 2:
            continue
        first, last = alike[0], alike[-1]
        since = change(first.estimate, last.estimate)
        before, after = first.estimate.value, last.estimate.value
        verdict, way, rules = _judged(measure, before, after, since, mdc, blocked)
        repeats.append(Repeat(number, first.session, last.session, since, mdc, verdict, way, rules))
    return repeats
