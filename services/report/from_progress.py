"""What services.progress says of a patient, as a report of one session needs it: up to that session's visit."""

from collections.abc import Sequence

from schemas.vocabulary import Side
from services.progress.points import Point
from services.progress.progress import Progress as Told
from services.progress.rules import Verdict
from services.progress.series import Series
from services.progress.visits import Trial, Visit, numbers_of_sessions
from services.report.source import CurveDistance, JointChange, MeasureProgress, Progress, Treatment, VisitValue


def progress_of(session: str, visits: Sequence[Visit], told: Told, treatments: Sequence[Treatment]) -> Progress | None:
    """Later visits are left out, so that the report of a session stays as it is when the patient comes again.

    None where the session belongs to no visit.
    """
    numbers = numbers_of_sessions(visits)
    if session not in numbers:
        return None
    number = numbers[session]
    trial = next(trial for visit in visits for trial in visit.trials if trial.session == session)
    mine = [each for each in told.series if (each.task, each.instruction) == _test(trial)]
    baseline = min((each.baseline.visit for each in mine if each.baseline is not None), default=None)
    if baseline is not None and baseline > number:
        baseline = None
    day = next((visit.day for visit in visits if visit.number == baseline), None)
    last = next(visit.day for visit in visits if visit.number == number)
    return Progress(
        visit=number,
        baseline_visit=baseline,
        baseline_day=day,
        measures=tuple(_measure(each, session, number) for each in mine),
        treatments=tuple(each for each in treatments if each.on <= last),
        distances=_distances(told, trial, number),
        joints=_joints(told, trial, number),
    )


def _test(trial: Trial) -> tuple[object, object]:
    return trial.task, trial.conditions.speed_instruction


def _measure(series: Series, session: str, number: int) -> MeasureProgress:
    values = [
        VisitValue(
            each.visit,
            each.day,
            each.value,
            each.low,
            each.high,
            None if each.change is None else each.change.value,
            each.verdict,
            tuple(each.rules),
        )
        for each in series.visits
        if each.visit <= number
    ]
    if not any(value.visit == number for value in values):
        values += [
            _not_comparable(each) for each in series.points if each.session == session and each.value is not None
        ]
    now = values[-1].rules if values and values[-1].visit == number else ()
    return MeasureProgress(
        metric=series.measure,
        side=None if series.side is None else Side(series.side),
        unit=series.unit,
        visits=tuple(values),
        baseline=None if series.baseline is None or series.baseline.visit > number else series.baseline.value,
        mdc=None if series.mdc is None else series.mdc.value,
        mdc_people=None if series.mdc is None else series.mdc.people,
        mdc_source=None if series.mdc is None else series.mdc.source,
        why_no_mdc=now if series.mdc is None else (),
    )


def _not_comparable(point: Point) -> VisitValue:
    assert point.value is not None
    rules = tuple(point.rules)
    return VisitValue(point.visit, point.day, point.value, point.low, point.high, None, Verdict.CANNOT_TELL, rules)


def _distances(told: Told, trial: Trial, number: int) -> tuple[CurveDistance, ...]:
    return tuple(
        CurveDistance(each.visit, each.side, each.from_baseline.distance, each.from_baseline.by_variable)
        for each in told.curves
        if (each.task, each.instruction) == _test(trial) and each.visit <= number and each.from_baseline is not None
    )


def _joints(told: Told, trial: Trial, number: int) -> tuple[JointChange, ...]:
    return tuple(
        JointChange(each.joint, each.word, tuple(each.rules))
        for each in told.joints
        if (each.task, each.instruction) == _test(trial) and len(each.visits) > 1 and each.visits[-1].visit == number
    )
