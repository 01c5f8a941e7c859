"""The audit in the database: appending to it and reading it."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from datetime import UTC, date, datetime, time, timedelta

from sqlalchemy import ColumnElement, func, or_, select, update
from sqlalchemy.orm import Session

from services.gateway.access.caller import Caller
from services.gateway.audit.chain import Entry, digest_of
from services.gateway.audit.tables import AuditHeadRow, AuditRow
from services.gateway.tables import PatientRow

HEAD = 1


def append(database: Session, entry: Entry) -> AuditRow:
    """Add an entry at the end of the chain. The head is written before it is read, which keeps others waiting."""
    move = update(AuditHeadRow).where(AuditHeadRow.id == HEAD).values(number=AuditHeadRow.number + 1)
    database.execute(move, execution_options={"synchronize_session": False})
    head = database.get_one(AuditHeadRow, HEAD)
    digest = digest_of(head.number, entry, head.digest)
    row = AuditRow(number=head.number, previous=head.digest, digest=digest, **asdict(entry))
    database.add(row)
    head.digest = digest
    return row


@dataclass(frozen=True, slots=True)
class Wanted:
    """Which entries are listed; null: any. Days are UTC, both included."""

    from_day: date | None = None
    to_day: date | None = None
    actor: str | None = None
    patient: str | None = None
    action: str | None = None

    def conditions(self) -> list[ColumnElement[bool]]:
        """For a query."""
        equal = ((AuditRow.actor, self.actor), (AuditRow.patient, self.patient), (AuditRow.action, self.action))
        wanted = [column == value for column, value in equal if value is not None]
        if self.from_day is not None:
            wanted.append(AuditRow.at >= datetime.combine(self.from_day, time.min, UTC))
        if self.to_day is not None and self.to_day < date.max:
            wanted.append(AuditRow.at < datetime.combine(self.to_day + timedelta(days=1), time.min, UTC))
        return wanted


def seen_by(caller: Caller) -> ColumnElement[bool]:
    """Entries that an administrator may read: what their clinic's people did, and what others did with its patients.

    Those of nobody known, such as wrong passwords, are for administrators of the site.
    """
    patients = select(PatientRow.code).where(PatientRow.clinic_id == caller.clinic)
    of_clinic = or_(AuditRow.clinic == caller.clinic, AuditRow.patient.in_(patients))
    return or_(of_clinic, AuditRow.clinic.is_(None)) if caller.site_admin else of_clinic


def list_entries(
    database: Session, seen: ColumnElement[bool], wanted: Wanted, offset: int, limit: int
) -> tuple[int, list[AuditRow]]:
    """Number of all entries that match, and some of them, newest first."""
    conditions = [seen, *wanted.conditions()]
    total = database.scalar(select(func.count()).select_from(AuditRow).where(*conditions)) or 0
    order = select(AuditRow).where(*conditions).order_by(AuditRow.number.desc())
    return total, list(database.scalars(order.offset(offset).limit(limit)))


def entries_from(
    database: Session, first: int, count: int, conditions: Sequence[ColumnElement[bool]] = ()
) -> list[AuditRow]:
    """Entries in the chain's order, from a number on."""
    order = select(AuditRow).where(AuditRow.number >= first, *conditions).order_by(AuditRow.number).limit(count)
    return list(database.scalars(order))


def entry_in(row: AuditRow) -> Entry:
    """The entry as it was chained."""
    return Entry(**{each.name: getattr(row, each.name) for each in fields(Entry)})
