"""REST of the bin."""

from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from datetime import UTC, date, datetime, timedelta
from http import HTTPStatus

from fastapi import APIRouter
from sqlalchemy.orm import Session

from services.gateway.access.rules import WORK
from services.gateway.access.scope import EVERYTHING
from services.gateway.context import Context, Gateway, PatientCode, SessionId
from services.gateway.patients.records import get_patient
from services.gateway.problems import Problem, documented, not_found
from services.gateway.recycling import records
from services.gateway.recycling.models import BinOut, BinPatientOut, BinSessionOut, RestoredOut
from services.gateway.sessions.records import get_session
from services.gateway.tables import PatientRow, SessionRow

router = APIRouter(prefix="/v1", tags=["bin"], dependencies=WORK)

CAN_FAIL = documented(HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT)


@router.delete("/patients/{code}", status_code=HTTPStatus.NO_CONTENT, responses=CAN_FAIL)
def discard_patient(code: PatientCode, gateway: Context) -> None:
    """Put a patient with all sessions into the bin. Not while one of them runs."""
    with gateway.transaction() as database:
        patient = get_patient(database, code)
        sessions = records.sessions_of(database, code)
        check_ended(gateway, sessions)
        records.discard([patient, *sessions], datetime.now(UTC))


@router.delete("/sessions/{session}", status_code=HTTPStatus.NO_CONTENT, responses=CAN_FAIL)
def discard_session(session: SessionId, gateway: Context) -> None:
    """Put a session into the bin. Not while it runs."""
    with gateway.transaction() as database:
        row = get_session(database, session)
        check_ended(gateway, [row])
        records.discard([row], datetime.now(UTC))


@router.get("/bin", responses=documented())
def read_bin(gateway: Context) -> BinOut:
    """What was deleted in one's clinic and can still be brought back."""
    with _bin(gateway) as database:
        patients = records.listed_patients(database)
        alone = records.listed_sessions(database)
        together = Counter(
            row.patient_code for each in patients for row in records.sessions_of(database, each.code)
            if row.deleted == each.deleted
        )  # fmt: skip
        return BinOut(
            keep_days=gateway.parameters.bin_days,
            patients=[_patient(gateway, row, together[row.code]) for row in patients],
            sessions=[_session(gateway, row) for row in alone],
        )


@router.post("/bin/patients/{code}/restoration", responses=documented(HTTPStatus.NOT_FOUND))
def restore_patient(code: PatientCode, gateway: Context) -> RestoredOut:
    """Bring a patient back, with the sessions that went into the bin with them."""
    with _bin(gateway) as database:
        patient = database.get(PatientRow, code)
        if patient is None:
            raise _not_in_bin("patient", code)
        return RestoredOut(patient=code, sessions=records.restore_patient(database, patient))


@router.post("/bin/sessions/{session}/restoration", responses=CAN_FAIL)
def restore_session(session: SessionId, gateway: Context) -> RestoredOut:
    """Bring a session back. One whose patient is in the bin comes back with them."""
    with _bin(gateway) as database:
        row = database.get(SessionRow, session)
        if row is None:
            raise _not_in_bin("session", session)
        if row.patient_code is not None and database.get(PatientRow, row.patient_code) is not None:
            step = f"Bring the patient back first: POST /v1/bin/patients/{row.patient_code}/restoration."
            raise Problem(HTTPStatus.CONFLICT, f"The patient of session {session} is in the bin, too.", step)
        patient = row.patient_code
    # The patient is not in the bin, so no scope has both.
    with gateway.database.transaction(EVERYTHING) as database:
        database.get_one(SessionRow, session).deleted = None
    return RestoredOut(patient=patient, sessions=1)


def check_ended(gateway: Gateway, sessions: Sequence[SessionRow]) -> None:
    """Raises a 409 problem when one of them still runs."""
    running = [*records.running_among(list(sessions)), *(row.id for row in sessions if gateway.live.is_live(row.id))]
    if running:
        step = f"Stop it with POST /v1/sessions/{running[0]}/stop, then try again."
        raise Problem(HTTPStatus.CONFLICT, f"Session {running[0]} still runs.", step)


@contextmanager
def _bin(gateway: Gateway) -> Iterator[Session]:
    with gateway.database.transaction(gateway.known_caller.bin) as database:
        yield database


def _erased_on(gateway: Gateway, deleted: datetime | None) -> date:
    assert deleted is not None, "it is in the bin"
    return (deleted + timedelta(days=gateway.parameters.bin_days)).date()


def _patient(gateway: Gateway, row: PatientRow, sessions: int) -> BinPatientOut:
    return BinPatientOut(
        code=row.code, deleted=row.deleted, erased_on=_erased_on(gateway, row.deleted), sessions=sessions
    )


def _session(gateway: Gateway, row: SessionRow) -> BinSessionOut:
    return BinSessionOut(
        id=row.id, patient=row.patient_code, task=row.task, created=row.created, deleted=row.deleted,
        erased_on=_erased_on(gateway, row.deleted),
    )  # fmt: skip


def _not_in_bin(noun: str, name: str) -> Problem:
    problem = not_found(noun, name)
    return Problem(problem.status, f"There is no {noun} {name} in the bin.", "List what is there with GET /v1/bin.")
