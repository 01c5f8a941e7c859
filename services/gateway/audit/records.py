"""Appending to the audit."""

from dataclasses import asdict

from sqlalchemy import update
from sqlalchemy.orm import Session

from services.gateway.audit.chain import Entry, digest_of
from services.gateway.audit.tables import AuditHeadRow, AuditRow

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
