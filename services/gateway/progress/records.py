"""A patient's baseline in the database, frozen when it is first needed."""

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from datetime import UTC, datetime
from typing import TypeVar

from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from schemas.population import Population
from services.gateway.tables import BaselineRow, PatientRow
from services.progress.baseline import Baseline, complete, freeze
from services.progress.visits import Visit, numbers_of_sessions

T = TypeVar("T")


def settled(transaction: Callable[[], AbstractContextManager[Session]], work: Callable[[Session], T]) -> T:
    """What `work` gives in a transaction. Where another request froze the same baseline meanwhile, it is done again
    and finds that one."""
    try:
        with transaction() as session:
            return work(session)
    except IntegrityError:
        with transaction() as session:
            return work(session)


def stored_baseline(database: Session, patient: str) -> Baseline | None:
    """The frozen one, if there is any."""
    row = database.get(BaselineRow, patient)
    return None if row is None else Baseline.model_validate(row.body)


def frozen_baseline(
    database: Session, patient: PatientRow, visits: list[Visit], references: Mapping[str, str]
) -> Baseline | None:
    """The stored baseline, with tests that have come since; the first usable visit where none was set; else null.

    A baseline whose session no longer belongs to the patient is forgotten.
    """
    population = None if patient.population is None else Population(patient.population)
    row = database.get(BaselineRow, patient.code)
    if row is not None and row.session_id not in numbers_of_sessions(visits):
        database.delete(row)
        database.flush()
        row = None
    if row is None:
        fresh = freeze(visits, None, population, references)
        return None if fresh is None else _keep_first(database, patient.code, fresh)
    stored = Baseline.model_validate(row.body)
    whole = complete(stored, visits, population)
    if whole != stored:
        row.body = whole.model_dump(mode="json")
    return whole


def chosen_baseline(
    database: Session, patient: PatientRow, visits: list[Visit], references: Mapping[str, str], session: str
) -> Baseline | None:
    """Freeze anew, counted from the visit of a session; null, and nothing changes, where that one is not usable."""
    population = None if patient.population is None else Population(patient.population)
    fresh = freeze(visits, session, population, references)
    return None if fresh is None else keep_baseline(database, patient.code, fresh)


def keep_baseline(database: Session, patient: str, baseline: Baseline) -> Baseline:
    """Store it in place of any other."""
    database.merge(_row(patient, baseline))
    database.flush()
    return baseline


def _keep_first(database: Session, patient: str, baseline: Baseline) -> Baseline:
    """Store it; one that somebody chose in between is not replaced. Raises IntegrityError then."""
    database.add(_row(patient, baseline))
    database.flush()
    return baseline


def _row(patient: str, baseline: Baseline) -> BaselineRow:
    body = baseline.model_dump(mode="json")
    return BaselineRow(patient_code=patient, session_id=baseline.session, frozen=datetime.now(UTC), body=body)


def delete_baseline(database: Session, patient: str) -> bool:
    """Forget it. False when there is none."""
    row = database.get(BaselineRow, patient)
    if row is None:
        return False
    database.delete(row)
    return True
