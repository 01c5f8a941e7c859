"""REST of reference sets."""

from http import HTTPStatus

from fastapi import APIRouter

from schemas.population import Sex
from services.gateway.access.rules import KNOWN, READ
from services.gateway.context import Context, Limit, Offset, SessionId
from services.gateway.problems import Problem, documented
from services.gateway.references import shapes
from services.gateway.references.models import ReferencePage, RefusedSetOut, SessionReferencesOut
from services.gateway.references.shelf import shelf_of
from services.gateway.sessions import records
from services.gateway.sessions.shapes import session_out, stored_metrics
from services.gateway.tables import PatientRow
from services.reference.bands import Person

router = APIRouter(prefix="/v1", tags=["references"])


@router.get("/references", dependencies=KNOWN, responses=documented())
def list_references(gateway: Context, offset: Offset = 0, limit: Limit = 50) -> ReferencePage:
    """List the reference sets: the clinic's own, then those that come with the software; and what was refused."""
    shelf = shelf_of(gateway)
    return ReferencePage(
        total=len(shelf.sets),
        items=[shapes.set_out(one) for one in shelf.sets[offset : offset + limit]],
        refused=[RefusedSetOut(folder=each.folder, where=each.where, what=each.what) for each in shelf.refused],
    )


@router.get("/sessions/{session}/references", dependencies=READ, responses=documented(HTTPStatus.NOT_FOUND))
def read_session_references(session: SessionId, gateway: Context) -> SessionReferencesOut:
    """Each metric of a session against the band of people like the patient, or why no band fits."""
    with gateway.transaction() as database:
        row = records.get_session(database, session)
        metrics, shown = stored_metrics(row), session_out(row)
        patient = None if row.patient_code is None else database.get(PatientRow, row.patient_code)
        began = row.started or row.created
    if metrics is None:
        raise Problem(HTTPStatus.NOT_FOUND, f"Session {session} has no metrics yet.", "Walk a few steps, read again.")
    born = None if patient is None else patient.year_of_birth
    sex = None if patient is None or patient.sex is None else Sex(patient.sex)
    age = None if born is None else began.year - born
    speed = None if shown.highlights is None else shown.highlights.walking_speed
    person = Person(None if age is None else float(age), sex, speed)
    found = shapes.metrics_against(shelf_of(gateway), metrics, person, shown.datum)
    return SessionReferencesOut(session=session, age=age, sex=sex, speed=speed, metrics=found)
