"""What the sessions of a patient have learned of the walk, handed on to the next one."""

from datetime import UTC, datetime

from sqlalchemy import ColumnElement, select
from sqlalchemy.orm import Session

from schemas.rhythm import KnownRhythm, LearnedRhythm, RhythmKind
from services.gateway.tables import RhythmRow, SessionRow
from services.progress.visits import SAME_VISIT


def record_rhythm(database: Session, session: str, rhythm: LearnedRhythm) -> bool:
    """Keep the newest of a session. False when the session is not known."""
    if database.get(SessionRow, session) is None:
        return False
    database.merge(RhythmRow(session_id=session, received=datetime.now(UTC), body=rhythm.model_dump(mode="json")))
    return True


def known_rhythms(database: Session, patient: str, now: datetime) -> list[KnownRhythm]:
    """The patient's newest trial of this visit and the newest of an earlier visit, as far as there are any."""
    earlier = now - SAME_VISIT
    found = [
        _newest(database, patient, "previous trial", SessionRow.created > earlier),
        _newest(database, patient, "previous visit", SessionRow.created <= earlier),
    ]
    return [known for known in found if known is not None]


def _newest(database: Session, patient: str, kind: RhythmKind, when: ColumnElement[bool]) -> KnownRhythm | None:
    rows = (
        select(RhythmRow)
        .join(SessionRow, RhythmRow.session_id == SessionRow.id)
        .where(SessionRow.patient_code == patient, when)
        .order_by(SessionRow.created.desc(), SessionRow.id)
        .limit(1)
    )
    row = database.scalar(rows)
    if row is None:
        return None
    return KnownRhythm(name=row.session_id, kind=kind, rhythm=LearnedRhythm.model_validate(row.body))
