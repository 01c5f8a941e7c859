"""Treatments in the database."""

from datetime import date

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from services.gateway.tables import TreatmentRow
from services.progress.treatments import TreatmentKind


def add_treatment(database: Session, patient: str, on: date, kind: TreatmentKind) -> TreatmentRow:
    """Note a treatment."""
    row = TreatmentRow(patient_code=patient, on=on, what=kind)
    database.add(row)
    database.flush()
    return row


def list_treatments(database: Session, patient: str, offset: int, limit: int) -> tuple[int, list[TreatmentRow]]:
    """Number of all treatments of a patient, and some of them, newest first."""
    of_patient = TreatmentRow.patient_code == patient
    total = database.scalar(select(func.count()).select_from(TreatmentRow).where(of_patient)) or 0
    order = select(TreatmentRow).where(of_patient).order_by(TreatmentRow.on.desc(), TreatmentRow.id.desc())
    return total, list(database.scalars(order.offset(offset).limit(limit)))


def delete_treatment(database: Session, patient: str, number: int) -> bool:
    """Take a treatment away. False when the patient has none of that number."""
    row = database.get(TreatmentRow, number)
    if row is None or row.patient_code != patient:
        return False
    database.delete(row)
    return True
