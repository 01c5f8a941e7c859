"""Two codes of one person become one."""

from sqlalchemy import select
from sqlalchemy.orm import Session

from services.gateway.access.tables import ShareRow
from services.gateway.tables import BaselineRow, PatientRow, SessionRow, TreatmentRow

FACTS = ("year_of_birth", "sex", "population", "paretic_side")


def conflicting_facts(one: PatientRow, other: PatientRow) -> list[str]:
    """What is known of both and not the same: then they may not be one person."""
    pairs = ((fact, getattr(one, fact), getattr(other, fact)) for fact in FACTS)
    return [fact for fact, a, b in pairs if a is not None and b is not None and a != b]


def merge(database: Session, gone: PatientRow, stays: PatientRow) -> list[str]:
    """Bring everything of one record under the other code and remove the first; ids of the sessions that moved.

    Facts that the record which stays lacks are taken over. Its baseline stays; where it has none, the other's comes
    along, with the thresholds that were frozen then.
    """
    for fact in FACTS:
        if getattr(stays, fact) is None:
            setattr(stays, fact, getattr(gone, fact))
    sessions = list(database.scalars(select(SessionRow).where(SessionRow.patient_code == gone.code)))
    for row in sessions:
        row.patient_code = stays.code
    for treatment in database.scalars(select(TreatmentRow).where(TreatmentRow.patient_code == gone.code)):
        treatment.patient_code = stays.code
    _move_shares(database, gone.code, stays.code)
    _move_baseline(database, gone.code, stays.code)
    database.flush()
    database.delete(gone)
    return [row.id for row in sessions]


def _move_shares(database: Session, gone: str, stays: str) -> None:
    for share in list(database.scalars(select(ShareRow).where(ShareRow.patient_code == gone))):
        if database.get(ShareRow, (stays, share.account_id)) is None:
            database.add(
                ShareRow(
                    patient_code=stays, account_id=share.account_id, granted_by=share.granted_by, granted=share.granted
                )
            )
        database.delete(share)


def _move_baseline(database: Session, gone: str, stays: str) -> None:
    row = database.get(BaselineRow, gone)
    if row is None:
        return
    if database.get(BaselineRow, stays) is None:
        database.add(BaselineRow(patient_code=stays, session_id=row.session_id, frozen=row.frozen, body=row.body))
    database.delete(row)
