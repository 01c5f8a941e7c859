"""Sessions in the database."""

import secrets
from dataclasses import dataclass
from datetime import UTC, date, datetime, time, timedelta

from sqlalchemy import ColumnElement, func, select
from sqlalchemy.orm import Session

from schemas.kinematics import Calibration
from schemas.metrics import SessionMetrics
from schemas.session import SessionDescription
from schemas.vocabulary import ESTIMATORS, Task
from services.gateway.problems import not_found
from services.gateway.sessions.models import SessionIn, SessionState
from services.gateway.tables import CalibrationRow, MetricsRow, SessionRow

DEFAULT_ESTIMATOR = "rhythmic_ekf"
REASON_LENGTH = 500


def new_session_id() -> str:
    """Random, so that it says nothing and never repeats."""
    return secrets.token_hex(8)


def add_requested(database: Session, session: str, wish: SessionIn, clinic: str) -> SessionRow:
    """Store the wish to start a session in a clinic, before an ingest is asked."""
    row = SessionRow(
        id=session,
        clinic_id=clinic,
        patient_code=wish.patient,
        title=wish.source,
        protocol="",
        state=SessionState.CREATED,
        reason=None,
        created=datetime.now(UTC),
        started=None,
        ended=None,
        duration_s=None,
        estimator=wish.estimator or DEFAULT_ESTIMATOR,
        origin="synthetic" if wish.source.startswith("synthetic:") else "recording",
        source=wish.source,
        task=wish.task,
        walkway_m=wish.walkway_m,
    )
    database.add(row)
    return row


def record_start(database: Session, description: SessionDescription, clinic: str) -> SessionRow:
    """Store that a session runs. One that nobody asked for becomes an unassigned session of that clinic."""
    row = database.get(SessionRow, description.session)
    if row is None:
        row = SessionRow(
            id=description.session, clinic_id=clinic, patient_code=None, created=datetime.now(UTC), source=None
        )
        database.add(row)
    row.title = description.title[:200]
    row.protocol = description.protocol[:100]
    row.estimator = description.estimator[:64]
    row.origin = description.origin
    row.task, row.walkway_m = description.task, description.walkway_m
    row.description = description.model_dump(mode="json", exclude={"known_rhythms"})
    row.started = datetime.fromtimestamp(description.started_unix_ns / 1e9, UTC)
    if row.state != SessionState.FINISHED:
        row.state, row.reason, row.ended = SessionState.LIVE, None, None
        row.duration_s = description.duration_s
    return row


def record_metrics(database: Session, session: str, metrics: SessionMetrics) -> bool:
    """Keep a session's newest metrics; final ones finish it. False when the session is not known."""
    row = database.get(SessionRow, session)
    if row is None:
        return False
    if row.metrics is None or metrics.final or not row.metrics.final:
        stored = MetricsRow(
            session_id=session,
            final=metrics.final,
            received=datetime.now(UTC),
            software=metrics.software[:100],
            body=metrics.model_dump(mode="json"),
        )
        database.merge(stored)
    if metrics.final:
        row.state, row.reason = SessionState.FINISHED, None
        _set_length(row, metrics.captured_ns / 1e9)
    return True


def record_calibration(database: Session, session: str, calibration: Calibration) -> bool:
    """Keep a session's newest calibration. False when the session is not known."""
    if database.get(SessionRow, session) is None:
        return False
    body = calibration.model_dump(mode="json")
    database.merge(CalibrationRow(session_id=session, received=datetime.now(UTC), body=body))
    return True


def record_length(database: Session, session: str, length_s: float) -> None:
    """A finished session went on after its last stride, to which its metrics reach."""
    row = database.get(SessionRow, session)
    if row is not None and row.state == SessionState.FINISHED and length_s > (row.duration_s or 0.0):
        _set_length(row, length_s)


def _set_length(row: SessionRow, length_s: float) -> None:
    row.duration_s = length_s
    row.ended = (row.started or row.created) + timedelta(seconds=length_s)


def record_end(database: Session, session: str, state: SessionState, reason: str) -> bool:
    """Close a session that did not finish by itself. False when it had an end already, or is not known."""
    row = database.get(SessionRow, session)
    if row is None or row.state not in (SessionState.CREATED, SessionState.LIVE):
        return False
    row.state, row.reason, row.ended = state, reason[:REASON_LENGTH], datetime.now(UTC)
    return True


def get_session(database: Session, session: str) -> SessionRow:
    """Raises a 404 problem when there is none of that id."""
    row = database.get(SessionRow, session)
    if row is None:
        raise not_found("session", session)
    return row


@dataclass(frozen=True, slots=True)
class Wanted:
    """Which sessions are listed; null: any. Days are UTC, both included."""

    state: SessionState | None = None
    patient: str | None = None
    task: Task | None = None
    from_day: date | None = None
    to_day: date | None = None

    def conditions(self) -> list[ColumnElement[bool]]:
        """For a query."""
        equal = ((SessionRow.state, self.state), (SessionRow.patient_code, self.patient), (SessionRow.task, self.task))
        wanted = [column == value for column, value in equal if value is not None]
        if self.from_day is not None:
            wanted.append(SessionRow.created >= _midnight(self.from_day))
        if self.to_day is not None and self.to_day < date.max:
            wanted.append(SessionRow.created < _midnight(self.to_day + timedelta(days=1)))
        return wanted


def list_sessions(database: Session, wanted: Wanted, offset: int, limit: int) -> tuple[int, list[SessionRow]]:
    """Number of all sessions that match, and some of them, newest first."""
    conditions = wanted.conditions()
    total = database.scalar(select(func.count()).select_from(SessionRow).where(*conditions)) or 0
    order = select(SessionRow).where(*conditions).order_by(SessionRow.created.desc(), SessionRow.id)
    return total, list(database.scalars(order.offset(offset).limit(limit)))


def _midnight(day: date) -> datetime:
    return datetime.combine(day, time.min, UTC)


def open_sessions(database: Session) -> list[str]:
    """Sessions that the database believes to be running."""
    running = SessionRow.state.in_([SessionState.CREATED, SessionState.LIVE])
    return list(database.scalars(select(SessionRow.id).where(running)))


def known_estimators() -> dict[str, str]:
    """Name -> what it is, the default first."""
    return {DEFAULT_ESTIMATOR: ESTIMATORS[DEFAULT_ESTIMATOR]} | ESTIMATORS
