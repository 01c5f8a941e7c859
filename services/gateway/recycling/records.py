"""Into the bin and out of it, in the database.

A patient goes with their sessions: all get the same time, so that bringing the patient back brings exactly those.
"""

from datetime import datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from services.gateway.sessions.models import SessionState
from services.gateway.tables import PatientRow, SessionRow

MOST_LISTED = 500
RUNNING = (SessionState.CREATED, SessionState.LIVE)


def sessions_of(database: Session, code: str) -> list[SessionRow]:
    """The patient's sessions, as far as the transaction sees them."""
    return list(database.scalars(select(SessionRow).where(SessionRow.patient_code == code)))


def running_among(sessions: list[SessionRow]) -> list[str]:
    """Ids of those that have not ended."""
    return [row.id for row in sessions if row.state in RUNNING]


def discard(rows: list[PatientRow | SessionRow], now: datetime) -> None:
    """Put rows that are there into the bin, as one thing."""
    for row in rows:
        if row.deleted is None:
            row.deleted = now


def listed_patients(database: Session) -> list[PatientRow]:
    """Those in the bin that the transaction sees, the last one first."""
    order = select(PatientRow).order_by(PatientRow.deleted.desc(), PatientRow.code).limit(MOST_LISTED)
    return list(database.scalars(order))


def listed_sessions(database: Session) -> list[SessionRow]:
    """Those in the bin by themselves, not with their patient, the last one first."""
    patient = select(PatientRow.code).where(
        PatientRow.code == SessionRow.patient_code, PatientRow.deleted == SessionRow.deleted
    )
    alone = select(SessionRow).where(~patient.correlate(SessionRow).exists())
    return list(database.scalars(alone.order_by(SessionRow.deleted.desc(), SessionRow.id).limit(MOST_LISTED)))


def restore_patient(database: Session, patient: PatientRow) -> int:
    """Bring a patient back, and the sessions that went with them; how many."""
    together = [row for row in sessions_of(database, patient.code) if row.deleted == patient.deleted]
    patient.deleted = None
    for row in together:
        row.deleted = None
    return len(together)
