"""REST of baseline and progress."""

from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Query
from pydantic import StringConstraints
from sqlalchemy.orm import Session

from schemas.population import Population
from schemas.vocabulary import Side, Task
from services.gateway.access.rules import READ, WORK
from services.gateway.context import Context, Gateway, PatientCode
from services.gateway.patients.records import get_patient
from services.gateway.problems import Problem, documented
from services.gateway.progress import records, shapes
from services.gateway.progress.models import BaselineIn, BaselineOut, ProgressOut
from services.gateway.references.shelf import reference_uses
from services.gateway.tables import BaselineRow, PatientRow
from services.gateway.visits.records import sessions_of, visits_of
from services.progress.baseline import Baseline
from services.progress.progress import Person, Progress, ReferenceUse, progress
from services.progress.visits import Visit, numbers_of_sessions

router = APIRouter(prefix="/v1/patients", tags=["progress"])

Measure = Annotated[str, StringConstraints(pattern="^[a-z0-9_]{1,64}$")]
NEEDS = "A usable visit has final metrics, and says aid, orthosis, footwear and how fast the person was asked to walk."


@router.get("/{code}/progress", dependencies=READ, responses=documented(HTTPStatus.NOT_FOUND))
def read_progress(
    code: PatientCode,
    gateway: Context,
    task: Annotated[Task | None, Query(description="only this task")] = None,
    measure: Annotated[
        list[Measure] | None, Query(max_length=50, description="only series of these measures; may be repeated")
    ] = None,
) -> ProgressOut:
    """Whether the patient really changed: each measure of each test over the visits, with its verdict and the rule.

    The first usable visit becomes the baseline when none was chosen; its thresholds are frozen then.
    """
    _, found = records.settled(
        gateway.transaction, lambda database: patient_progress(database, gateway, code, task, measure)
    )
    return shapes.progress_out(code, found)


def patient_progress(
    database: Session,
    gateway: Gateway,
    code: str,
    task: Task | None = None,
    measures: list[str] | None = None,
) -> tuple[list[Visit], Progress]:
    """Visits and progress of a patient. Raises a 404 problem when there is none of that code."""
    patient, visits = _known(database, code)
    uses = reference_uses(gateway)
    baseline = records.frozen_baseline(database, patient, visits, _versions(uses))
    return visits, progress(visits, baseline, _person(patient, uses), task, measures)


@router.get("/{code}/baseline", dependencies=READ, responses=documented(HTTPStatus.NOT_FOUND))
def read_baseline(code: PatientCode, gateway: Context) -> BaselineOut:
    """What progress counts from. The first usable visit, when none was chosen."""

    def read(database: Session) -> BaselineOut:
        patient, visits = _known(database, code)
        baseline = records.frozen_baseline(database, patient, visits, _versions(reference_uses(gateway)))
        if baseline is None:
            raise Problem(HTTPStatus.NOT_FOUND, f"Patient {code} has no usable visit yet.", NEEDS)
        return _shape(database, code, baseline, visits)

    return records.settled(gateway.transaction, read)


@router.put("/{code}/baseline", dependencies=WORK, responses=documented(HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT))
def choose_baseline(code: PatientCode, body: BaselineIn, gateway: Context) -> BaselineOut:
    """Let progress count from the visit of a session; speed band and thresholds are chosen anew and frozen."""
    with gateway.transaction() as database:
        patient, visits = _known(database, code)
        if body.session not in numbers_of_sessions(visits):
            detail = f"Session {body.session} is none of patient {code}."
            raise Problem(HTTPStatus.NOT_FOUND, detail, f"List them with GET /v1/patients/{code}/visits.")
        versions = _versions(reference_uses(gateway))
        baseline = records.chosen_baseline(database, patient, visits, versions, body.session)
        if baseline is None:
            raise Problem(HTTPStatus.CONFLICT, f"The visit of session {body.session} is not usable.", NEEDS)
        return _shape(database, code, baseline, visits)


@router.delete(
    "/{code}/baseline", dependencies=WORK, status_code=HTTPStatus.NO_CONTENT, responses=documented(HTTPStatus.NOT_FOUND)
)
def forget_baseline(code: PatientCode, gateway: Context) -> None:
    """Forget the baseline; the first usable visit takes its place, with the thresholds that fit then."""
    with gateway.transaction() as database:
        get_patient(database, code)
        if not records.delete_baseline(database, code):
            raise Problem(HTTPStatus.NOT_FOUND, f"Patient {code} has no baseline.", "There is nothing to forget.")


def _known(database: Session, code: str) -> tuple[PatientRow, list[Visit]]:
    return get_patient(database, code), visits_of(sessions_of(database, code))


def _person(patient: PatientRow, uses: dict[str, ReferenceUse]) -> Person:
    population = None if patient.population is None else Population(patient.population)
    side = None if patient.paretic_side is None else Side(patient.paretic_side)
    return Person(population, side, uses)


def _versions(uses: dict[str, ReferenceUse]) -> dict[str, str]:
    return {name: use.version for name, use in uses.items()}


def _shape(database: Session, code: str, baseline: Baseline, visits: list[Visit]) -> BaselineOut:
    row = database.get_one(BaselineRow, code)
    return shapes.baseline_out(code, row.frozen, baseline, visits)
