"""The one place that decides which patients and sessions exist for whom.

A transaction carries a scope. Every query in it, whoever wrote it, is narrowed to that scope by the database layer
(`narrow`), so a route can not forget it: what belongs to another clinic, or lies in the bin, is simply not there.
"""

from dataclasses import dataclass
from typing import Any

from sqlalchemy import ColumnElement, and_, or_, select
from sqlalchemy.orm import ORMExecuteState, with_loader_criteria

from services.gateway.access.statements import check_statement
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
NARROWED = frozenset({PatientRow, SessionRow, *OF_SESSIONS, *OF_PATIENTS})


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
    """Before each query: add the scope's conditions to every table that holds something of a patient.

    Raises OutOfScope for a statement to which they can not be added.
    """
    scope: Scope = state.session.info[SCOPE]
    if scope.clinic is None or state.is_column_load:
        return
    if not state.is_relationship_load:
        check_statement(state, NARROWED)
    sessions = select(SessionRow.id).where(scope.sessions()).scalar_subquery()
    patients = select(PatientRow.code).where(scope.patients()).scalar_subquery()
    options = [
        _narrowed(PatientRow, scope.patients()),
        _narrowed(SessionRow, scope.sessions()),
        *(_narrowed(table, table.session_id.in_(sessions)) for table in OF_SESSIONS),
        *(_narrowed(table, table.patient_code.in_(patients)) for table in OF_PATIENTS),
    ]
    state.statement = state.statement.options(*options)


def _narrowed(table: Any, condition: ColumnElement[bool]) -> Any:
    return with_loader_criteria(table, condition, include_aliases=True)
