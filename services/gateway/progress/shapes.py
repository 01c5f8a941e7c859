"""Baseline and progress as the API shows them."""

from datetime import datetime

from services.gateway.progress.models import (
    BaselineOut,
    CurveVisitOut,
    JointRecoveryOut,
    MdcOut,
    ProgressOut,
    SeriesOut,
    TestBaselineOut,
)
from services.progress.baseline import Baseline, TestBaseline
from services.progress.progress import Progress
from services.progress.visits import Visit, numbers_of_sessions


def progress_out(patient: str, found: Progress) -> ProgressOut:
    """All series and joints."""
    return ProgressOut(
        patient=patient,
        series=[SeriesOut.model_validate(each) for each in found.series],
        joint_recovery=[JointRecoveryOut.model_validate(each) for each in found.joints],
        curve_distance=[CurveVisitOut.model_validate(each) for each in found.curves],
    )


def baseline_out(patient: str, frozen: datetime, baseline: Baseline, visits: list[Visit]) -> BaselineOut:
    """A baseline with the numbers and days of its visits."""
    numbers = numbers_of_sessions(visits)
    number = numbers[baseline.session]
    return BaselineOut(
        patient=patient,
        session=baseline.session,
        visit=number,
        day=visits[number - 1].day,
        frozen=frozen,
        chosen=baseline.chosen,
        population=baseline.population,
        table=baseline.table,
        references=baseline.references,
        tests=[
            _test_out(test, visits[numbers[test.sessions[0]] - 1])
            for test in baseline.tests
            if test.sessions[0] in numbers
        ],
    )


def _test_out(test: TestBaseline, visit: Visit) -> TestBaselineOut:
    thresholds: dict[str, list[MdcOut]] = {}
    for row in test.thresholds:
        thresholds.setdefault(row.measure, []).append(MdcOut.model_validate(row))
    return TestBaselineOut(
        task=test.task,
        instruction=test.instruction,
        visit=visit.number,
        day=visit.day,
        sessions=test.sessions,
        speed=test.speed,
        thresholds=thresholds,
    )
