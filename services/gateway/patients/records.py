"""Patients in the database."""

import secrets
from datetime import UTC, datetime

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from schemas.conditions import UNSAID, Conditions
from schemas.vocabulary import Side
from services.gateway.patients.models import PatientIn
from services.gateway.problems import not_found
from services.gateway.tables import PatientRow, SessionRow

ALPHABET = "23456789ABCDEFGHJKMNPQRSTVWXYZ"
"""Without the letters and digits that are mistaken for one another when read out."""

CODE_LENGTH = 6


def add_patient(database: Session, person: PatientIn) -> PatientRow:
    """Store a new patient under a fresh random code."""
    code = _random_code()
    while database.get(PatientRow, code) is not None:
        code = _random_code()
    row = PatientRow(code=code, created=datetime.now(UTC), **person.model_dump())
    database.add(row)
    return row


def get_patient(database: Session, code: str) -> PatientRow:
    """Raises a 404 problem when there is none of that code."""
    row = database.get(PatientRow, code)
    if row is None:
        raise not_found("patient", code)
    return row


def with_known_side(conditions: Conditions | None, patient: PatientRow) -> Conditions | None:
    """Conditions in which the paretic side is the patient's, unless they name one themselves."""
    if patient.paretic_side is None or (conditions is not None and conditions.paretic_side is not None):
        return conditions
    return (conditions or UNSAID).model_copy(update={"paretic_side": Side(patient.paretic_side)})


def list_patients(database: Session, offset: int, limit: int) -> tuple[int, list[PatientRow]]:
    """Number of all patients, and some of them, newest first."""
    total = database.scalar(select(func.count()).select_from(PatientRow)) or 0
    order = select(PatientRow).order_by(PatientRow.created.desc(), PatientRow.code)
    return total, list(database.scalars(order.offset(offset).limit(limit)))


def count_sessions(database: Session, codes: list[str]) -> dict[str, int]:
    """Sessions linked to each of the patients; patients without any are missing."""
    counted = (
        select(SessionRow.patient_code, func.count())
        .where(SessionRow.patient_code.in_(codes))
        .group_by(SessionRow.patient_code)
    )
    return {code: count for code, count in database.execute(counted) if code is not None}


def _random_code() -> str:
    return "".join(secrets.choice(ALPHABET) for _ in range(CODE_LENGTH))
