"""Current and former results of a session in the database."""

from datetime import UTC, datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from schemas.metrics import SessionMetrics
from schemas.session import SessionDescription
from services.gateway.tables import FormerMetricsRow, MetricsRow, SessionRow

SOFTWARE_LENGTH = 100


def replace_metrics(
    database: Session, session: str, metrics: SessionMetrics, description: SessionDescription | None = None
) -> bool:
    """Make a result the session's current one and keep the final one before it under its software.

    False when the session is not known. The same software's earlier result is replaced, not kept beside. The
    `description` is stored where a session from before it was kept has none.
    """
    row = database.get(SessionRow, session)
    if row is None:
        return False
    if row.description is None and description is not None:
        row.description = description.model_dump(mode="json", exclude={"known_rhythms"})
    now, software, current = datetime.now(UTC), metrics.software[:SOFTWARE_LENGTH], row.metrics
    if current is not None and current.final and current.software != software:
        former = FormerMetricsRow(
            session_id=session,
            software=current.software,
            received=current.received,
            replaced=now,
            body=current.body,
        )
        database.merge(former)
    again = database.get(FormerMetricsRow, (session, software))
    if again is not None:
        database.delete(again)
    body = metrics.model_dump(mode="json")
    database.merge(MetricsRow(session_id=session, final=metrics.final, received=now, software=software, body=body))
    return True


def former_metrics(database: Session, session: str) -> list[FormerMetricsRow]:
    """Results that were replaced, the last replaced first."""
    order = select(FormerMetricsRow).where(FormerMetricsRow.session_id == session)
    return list(database.scalars(order.order_by(FormerMetricsRow.replaced.desc(), FormerMetricsRow.software)))
