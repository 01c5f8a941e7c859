"""What the database holds of erased patients and sessions, removed. What hangs on them goes with them."""

from collections.abc import Iterable, Iterator, Sequence

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from services.gateway.erasure.tombstones import Tombstone, digest_of
from services.gateway.tables import PatientRow, SessionRow

AT_ONCE = 500


def erase_rows(database: Session, patients: Sequence[str], sessions: Sequence[str]) -> None:
    """Remove patients with all their sessions, and single sessions; the database removes what refers to them."""
    for some in _portions(sessions):
        database.execute(delete(SessionRow).where(SessionRow.id.in_(some)))
    for some in _portions(patients):
        database.execute(delete(SessionRow).where(SessionRow.patient_code.in_(some)))
        database.execute(delete(PatientRow).where(PatientRow.code.in_(some)))


def come_back(database: Session, tombstones: Iterable[Tombstone]) -> tuple[list[str], list[str]]:
    """Codes and sessions that were erased and are there all the same, as after restoring an older backup.

    A patient who was registered after the erasure, and drew the same code, is another one.
    """
    erased = list(tombstones)
    erased_at = {each.patient_sha256: each.at for each in erased}
    codes = [
        code
        for code, created in database.execute(select(PatientRow.code, PatientRow.created))
        if (at := erased_at.get(digest_of(code))) is not None and created <= at
    ]
    sessions: list[str] = []
    for some in _portions([session for each in erased for session in each.sessions]):
        sessions += database.scalars(select(SessionRow.id).where(SessionRow.id.in_(some)))
    for some in _portions(codes):
        sessions += database.scalars(select(SessionRow.id).where(SessionRow.patient_code.in_(some)))
    return codes, list(dict.fromkeys(sessions))


def _portions(items: Sequence[str]) -> Iterator[Sequence[str]]:
    for start in range(0, len(items), AT_ONCE):
        yield items[start : start + AT_ONCE]
