"""REST of visits."""

from http import HTTPStatus

from fastapi import APIRouter

from services.gateway.access.rules import READ
from services.gateway.context import Context, Limit, Offset, PatientCode
from services.gateway.patients.records import get_patient
from services.gateway.problems import documented
from services.gateway.progress.records import stored_baseline
from services.gateway.visits.models import VisitPage
from services.gateway.visits.records import sessions_of, visits_of
from services.gateway.visits.shapes import visit_out

router = APIRouter(prefix="/v1/patients", tags=["progress"])


@router.get("/{code}/visits", dependencies=READ, responses=documented(HTTPStatus.NOT_FOUND))
def list_visits(code: PatientCode, gateway: Context, offset: Offset = 0, limit: Limit = 50) -> VisitPage:
    """List the visits of a patient, newest first: what was done and the headline metrics."""
    with gateway.transaction() as database:
        get_patient(database, code)
        rows = sessions_of(database, code)
        visits = visits_of(rows)
        baseline = stored_baseline(database, code)
        known = {row.id: row for row in rows}
        shown = visits[::-1][offset : offset + limit]
        return VisitPage(total=len(visits), items=[visit_out(visit, known, baseline) for visit in shown])
