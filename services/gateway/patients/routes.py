"""REST of patients."""

from http import HTTPStatus

from fastapi import APIRouter, Request
from sqlalchemy.orm import Session

from services.gateway.access.rules import READ, WORK
from services.gateway.audit.noting import Noted, note
from services.gateway.context import Context, Limit, Offset, PatientCode
from services.gateway.patients import records
from services.gateway.patients.models import PatientChange, PatientIn, PatientOut, PatientPage
from services.gateway.problems import documented
from services.gateway.tables import PatientRow

router = APIRouter(prefix="/v1/patients", tags=["patients"])


@router.post("", dependencies=WORK, status_code=HTTPStatus.CREATED, responses=documented())
def create_patient(body: PatientIn, gateway: Context, request: Request) -> PatientOut:
    """Register a patient; the answer has the random code to write on the chart."""
    with gateway.transaction() as database:
        row = records.add_patient(database, body)
        note(request, Noted(patients=(row.code,)))
        return _shape(database, [row])[0]


@router.get("", dependencies=READ, responses=documented())
def list_patients(gateway: Context, offset: Offset = 0, limit: Limit = 50) -> PatientPage:
    """List the patients, newest first."""
    with gateway.transaction() as database:
        total, rows = records.list_patients(database, offset, limit)
        return PatientPage(total=total, items=_shape(database, rows))


@router.get("/{code}", dependencies=READ, responses=documented(HTTPStatus.NOT_FOUND))
def read_patient(code: PatientCode, gateway: Context) -> PatientOut:
    """One patient."""
    with gateway.transaction() as database:
        return _shape(database, [records.get_patient(database, code)])[0]


@router.patch("/{code}", dependencies=WORK, responses=documented(HTTPStatus.NOT_FOUND))
def change_patient(code: PatientCode, body: PatientChange, gateway: Context) -> PatientOut:
    """Correct what is known of the patient. Fields that are left out stay; null takes one out."""
    with gateway.transaction() as database:
        row = records.get_patient(database, code)
        for name, value in body.model_dump(exclude_unset=True).items():
            setattr(row, name, value)
        return _shape(database, [row])[0]


def _shape(database: Session, rows: list[PatientRow]) -> list[PatientOut]:
    counts = records.count_sessions(database, [row.code for row in rows])
    return [
        PatientOut(
            code=row.code,
            year_of_birth=row.year_of_birth,
            sex=row.sex,
            population=row.population,
            paretic_side=row.paretic_side,
            created=row.created,
            sessions=counts.get(row.code, 0),
        )
        for row in rows
    ]
