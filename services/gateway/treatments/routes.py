"""REST of treatments."""

from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Path

from services.gateway.access.rules import READ, WORK
from services.gateway.context import Context, Limit, Offset, PatientCode
from services.gateway.patients.records import get_patient
from services.gateway.problems import Problem, documented
from services.gateway.tables import TreatmentRow
from services.gateway.treatments import records
from services.gateway.treatments.models import TreatmentIn, TreatmentOut, TreatmentPage
from services.progress.treatments import TreatmentKind

router = APIRouter(prefix="/v1/patients", tags=["progress"])

Number = Annotated[int, Path(ge=1, description="number of the treatment", examples=[7])]


@router.post(
    "/{code}/treatments", dependencies=WORK, status_code=HTTPStatus.CREATED, responses=documented(HTTPStatus.NOT_FOUND)
)
def add_treatment(code: PatientCode, body: TreatmentIn, gateway: Context) -> TreatmentOut:
    """Note what was done for the patient on a day; shown as a mark beside the progress."""
    with gateway.transaction() as database:
        get_patient(database, code)
        return _shape(records.add_treatment(database, code, body.date, body.kind))


@router.get("/{code}/treatments", dependencies=READ, responses=documented(HTTPStatus.NOT_FOUND))
def list_treatments(code: PatientCode, gateway: Context, offset: Offset = 0, limit: Limit = 50) -> TreatmentPage:
    """List what was done for the patient, newest first."""
    with gateway.transaction() as database:
        get_patient(database, code)
        total, rows = records.list_treatments(database, code, offset, limit)
        return TreatmentPage(total=total, items=[_shape(row) for row in rows])


@router.delete(
    "/{code}/treatments/{number}",
    dependencies=WORK,
    status_code=HTTPStatus.NO_CONTENT,
    responses=documented(HTTPStatus.NOT_FOUND),
)
def delete_treatment(code: PatientCode, number: Number, gateway: Context) -> None:
    """Take a treatment away that was noted by mistake."""
    with gateway.transaction() as database:
        get_patient(database, code)
        if not records.delete_treatment(database, code, number):
            raise Problem(
                HTTPStatus.NOT_FOUND,
                f"Patient {code} has no treatment {number}.",
                f"List what exists with GET /v1/patients/{code}/treatments.",
            )


def _shape(row: TreatmentRow) -> TreatmentOut:
    return TreatmentOut(id=row.id, date=row.on, kind=TreatmentKind(row.what))
