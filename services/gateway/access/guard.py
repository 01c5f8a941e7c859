"""What a scope lets be written: its own patients and sessions, and what hangs on those that it sees.

A shared patient may be read and walk with us; what is known of them is their own clinic's to change.
"""

from typing import Any

from sqlalchemy import inspect
from sqlalchemy.orm import Session, UOWTransaction

from services.gateway.access.scope import OF_PATIENTS, OF_SESSIONS, SCOPE, Scope
from services.gateway.access.statements import OutOfScope
from services.gateway.tables import BaselineRow, PatientRow, SessionRow


def check_rows(session: Session, _: UOWTransaction, __: object) -> None:
    """Before each write: new patients and sessions are given to the scope's clinic. Raises OutOfScope."""
    scope: Scope = session.info[SCOPE]
    if scope.clinic is None:
        return
    for row in session.new:
        if isinstance(row, PatientRow | SessionRow) and row.clinic_id is None:
            row.clinic_id = scope.clinic
    for row in session.deleted:
        _check_own(row, scope)
    for row in (*session.new, *session.dirty):
        if session.is_modified(row):
            _check_row(session, row, scope)


def _check_row(session: Session, row: Any, scope: Scope) -> None:
    if isinstance(row, PatientRow):
        _check_own(row, scope)
    elif isinstance(row, SessionRow):
        _check_session(session, row, scope)
    elif isinstance(row, OF_SESSIONS):
        _check_there(session, SessionRow, row.session_id)
    elif isinstance(row, OF_PATIENTS):
        _check_there(session, PatientRow, row.patient_code)
        if isinstance(row, BaselineRow):
            _check_there(session, SessionRow, row.session_id)


def _check_own(row: Any, scope: Scope) -> None:
    if isinstance(row, PatientRow | SessionRow) and {row.clinic_id, _before(row, "clinic_id")} != {scope.clinic}:
        raise OutOfScope("this is changed by its own clinic alone")


def _check_session(session: Session, row: SessionRow, scope: Scope) -> None:
    if row.patient_code is not None:
        _check_there(session, PatientRow, row.patient_code)
    if row.clinic_id != scope.clinic and row.patient_code not in scope.shared:
        raise OutOfScope("the session belongs to another clinic")
    taken = {row.clinic_id, _before(row, "clinic_id")} != {row.clinic_id} or row.deleted != _before(row, "deleted")
    if taken and _before(row, "clinic_id") != scope.clinic:
        raise OutOfScope("a session of another clinic is moved and thrown away there alone")


def _check_there(session: Session, table: type[PatientRow | SessionRow], key: str) -> None:
    name = table.__mapper__.primary_key[0].name
    pending = {getattr(row, name) for row in session.new if isinstance(row, table)}
    if key not in pending and session.get(table, key) is None:
        raise OutOfScope("it is about somebody who is not there for the caller")


def _before(row: Any, name: str) -> Any:
    """The value in the database; of a new row its own."""
    history = inspect(row).attrs[name].history
    return history.deleted[0] if history.deleted else getattr(row, name)
