"""The list of patients in the database."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import ColumnElement, func, select
from sqlalchemy.orm import Session

from schemas.population import Population
from services.gateway.tables import PatientRow, SessionRow
from services.progress.visits import visit_lengths

BEGAN = func.coalesce(SessionRow.started, SessionRow.created)


@dataclass(frozen=True, slots=True)
class Wanted:
    """Which patients: part of their code, their group, or some codes; None for any."""

    search: str | None = None
    population: Population | None = None
    codes: Sequence[str] | None = None


@dataclass(frozen=True, slots=True)
class Comings:
    """How often somebody came, and when last."""

    visits: int
    sessions: int
    last: datetime | None


NEVER = Comings(0, 0, None)


def list_wanted(database: Session, wanted: Wanted, offset: int, limit: int) -> tuple[int, list[PatientRow]]:
    """Number of all patients that match, and some of them: who came, or was registered, last first."""
    conditions = _conditions(wanted)
    total = database.scalar(select(func.count(PatientRow.code)).where(*conditions)) or 0
    came = select(func.max(BEGAN)).where(SessionRow.patient_code == PatientRow.code).scalar_subquery()
    newest = func.coalesce(came, PatientRow.created)
    rows = select(PatientRow).where(*conditions).order_by(newest.desc(), PatientRow.code)
    return total, list(database.scalars(rows.offset(offset).limit(limit)))


def comings(database: Session, codes: Sequence[str]) -> dict[str, Comings]:
    """Of each of the patients; those who never came are missing."""
    rows = select(SessionRow.patient_code, BEGAN).where(SessionRow.patient_code.in_(codes)).order_by(BEGAN)
    began: dict[str, list[datetime]] = {}
    for code, at in database.execute(rows):
        if code is not None:
            began.setdefault(code, []).append(at)
    return {code: Comings(len(visit_lengths(times)), len(times), times[-1]) for code, times in began.items()}


def _conditions(wanted: Wanted) -> list[ColumnElement[bool]]:
    conditions: list[ColumnElement[bool]] = []
    if wanted.search:
        conditions.append(PatientRow.code.contains(wanted.search, autoescape=True))
    if wanted.population is not None:
        conditions.append(PatientRow.population == wanted.population)
    if wanted.codes is not None:
        conditions.append(PatientRow.code.in_(wanted.codes))
    return conditions
