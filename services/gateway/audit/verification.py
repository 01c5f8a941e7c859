"""Is the chain whole: every entry as it was written, none missing, and its end where it was last signed?"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from sqlalchemy.orm import Session

from services.gateway.audit import records
from services.gateway.audit.chain import BEGINNING, digest_of
from services.gateway.audit.heads import SignedHead
from services.gateway.audit.tables import AuditHeadRow, AuditRow

BATCH = 1000


@dataclass(frozen=True, slots=True)
class Verdict:
    """`broken`: number of the first entry that is not as it was; `fault`: what is wrong there; both None when whole.

    `signed`: the newest signed head that was compared.
    """

    entries: int
    broken: int | None
    fault: str | None
    signed: SignedHead | None


class _Broken(Exception):
    def __init__(self, number: int, fault: str) -> None:
        super().__init__(fault)
        self.number = number


def verify(database: Session, heads: Sequence[SignedHead]) -> Verdict:
    """Walk the whole chain. `heads` have been found to be signed with the gateway's key."""
    signed = max(heads, key=lambda head: head.number, default=None)
    promised = {head.number: head.digest for head in heads}
    count, last = 0, BEGINNING
    try:
        for row in _rows(database):
            _check(row, count + 1, last)
            count, last = row.number, row.digest
            if promised.get(count, last) != last:
                raise _Broken(count, "the chain was written anew: its digest is not the one that was signed")
        _check_end(database, count, last, signed)
    except _Broken as broken:
        return Verdict(count, broken.number, str(broken), signed)
    return Verdict(count, None, None, signed)


def _rows(database: Session) -> Iterator[AuditRow]:
    # By batches, so that the length of the audit does not decide the memory; each is let go of after it was looked at.
    first = 0
    while True:
        try:
            rows = records.entries_from(database, first, BATCH)
        except (ValueError, TypeError) as error:
            raise _Broken(_unreadable(database, first), "a field is no value of its kind") from error
        yield from rows
        if not rows:
            return
        first = rows[-1].number + 1
        database.expunge_all()


def _unreadable(database: Session, first: int) -> int:
    number = max(first, 1)
    while True:
        try:
            records.entries_from(database, number, 1)
        except (ValueError, TypeError):
            return number
        number += 1


def _check(row: AuditRow, number: int, previous: str) -> None:
    if row.number != number:
        raise _Broken(number, "the entry is missing")
    if row.previous != previous:
        raise _Broken(number, "the entry does not follow the one before it")
    if row.digest != digest_of(number, records.entry_in(row), previous):
        raise _Broken(number, "the entry was changed")


def _check_end(database: Session, count: int, last: str, signed: SignedHead | None) -> None:
    head = database.get(AuditHeadRow, records.HEAD)
    if signed is not None and signed.number > count:
        raise _Broken(count + 1, f"the end is missing: {signed.number} entries had been signed")
    if head is None or (head.number, head.digest) != (count, last):
        raise _Broken(count + 1, "the chain does not end where its head says")
