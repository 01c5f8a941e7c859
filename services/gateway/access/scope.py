"""The one place that decides which patients and sessions exist for whom.

A transaction carries a scope. Every query in it, whoever wrote it, is narrowed to that scope by the database layer
(`narrow`), so a route can not forget it: what belongs to another clinic, or lies in the bin, is simply not there.
"""

from dataclasses import dataclass
from typing import Any

from sqlalchemy import ColumnElement, and_, or_, select
from sqlalchemy.orm import ORMExecuteState, Session, UOWTransaction, with_loader_criteria

from services.gateway.tables import (
    BaselineRow,
    CalibrationRow,
    FormerMetricsRow,
    MetricsRow,
    PatientRow,
    RhythmRow,
    SessionRow,
    TreatmentRow,
)

OF_SESSIONS = (MetricsRow, FormerMetricsRow, CalibrationRow, RhythmRow)
OF_PATIENTS = (BaselineRow, TreatmentRow)


class OutOfScope(PermissionError):
    """Something was to be written that is not the caller's to change."""


@dataclass(frozen=True, slots=True)
class Scope:
    """A clinic's patients and sessions, and those of others that were shared; `clinic` None: all there are.

    `in_bin`: those that were deleted, instead of those that were not.
    """

    clinic: str | None
    shared: frozenset[str] = frozenset()
    in_bin: bool = False

    def sees(self, clinic: str | None, patient: str | None) -> bool:
        """Whether a running session of that clinic and patient exists in this scope."""
        return self.clinic is None or clinic == self.clinic or patient in self.shared

    def patients(self) -> ColumnElement[bool]:
        """For queries of patients."""
        return and_(
            self._present(PatientRow), or_(PatientRow.clinic_id == self.clinic, self._is_shared(PatientRow.code))
        )

    def sessions(self) -> ColumnElement[bool]:
        """For queries of sessions."""
        mine = or_(SessionRow.clinic_id == self.clinic, self._is_shared(SessionRow.patient_code))
        return and_(self._present(SessionRow), mine)

    def _present(self, table: type[PatientRow | SessionRow]) -> ColumnElement[bool]:
        return table.deleted.is_not(None) if self.in_bin else table.deleted.is_(None)

    def _is_shared(self, column: Any) -> ColumnElement[bool]:
        condition: ColumnElement[bool] = column.in_(sorted(self.shared))
        return condition


EVERYTHING = Scope(None)
"""For the gateway's own housekeeping; never for a request."""

SCOPE = "scope"


def narrow(state: ORMExecuteState) -> None:
    """Before each query: add the scope's conditions to every table that holds something of a patient."""
    scope: Scope = state.session.info[SCOPE]
    if scope.clinic is None or state.is_column_load or state.is_relationship_load:
        return
    sessions = select(SessionRow.id).where(scope.sessions()).scalar_subquery()
    patients = select(PatientRow.code).where(scope.patients()).scalar_subquery()
    options = [
        with_loader_criteria(PatientRow, scope.patients(), propagate_to_loaders=False),
        with_loader_criteria(SessionRow, scope.sessions(), propagate_to_loaders=False),
        *(_narrowed(table, table.session_id.in_(sessions)) for table in OF_SESSIONS),
        *(_narrowed(table, table.patient_code.in_(patients)) for table in OF_PATIENTS),
    ]
    state.statement = state.statement.options(*options)


def _narrowed(table: Any, condition: ColumnElement[bool]) -> Any:
    return with_loader_criteria(table, condition, propagate_to_loaders=False)


def guard(session: Session, _: UOWTransaction, __: object) -> None:
    """Before each write: new patients and sessions are the scope's own, and only those are changed.

    A shared patient may be read and walk with us; what is known of them is their own clinic's to change.
    """
    scope: Scope = session.info[SCOPE]
    if scope.clinic is None:
        return
    for row in session.new:
        if isinstance(row, PatientRow | SessionRow) and row.clinic_id is None:
            row.clinic_id = scope.clinic
    changed = [
        row
        for row in (*session.new, *session.dirty, *session.deleted)
        if session.is_modified(row) or row in session.deleted
    ]
    for row in changed:
        if isinstance(row, PatientRow) and row.clinic_id != scope.clinic:
            raise OutOfScope("a shared patient is changed by their own clinic alone")
        if isinstance(row, SessionRow) and row.clinic_id != scope.clinic and row.patient_code not in scope.shared:
            raise OutOfScope("the session belongs to another clinic")
