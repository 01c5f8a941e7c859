"""The audit as a file, written while it is sent: its length does not decide the memory."""

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager

from sqlalchemy import ColumnElement
from sqlalchemy.orm import Session

from services.gateway.audit import fhir, records
from services.gateway.audit.heads import SignedHead
from services.gateway.audit.models import AuditEntryOut
from services.gateway.audit.tables import AuditRow

BATCH = 500
Transaction = Callable[[], AbstractContextManager[Session]]


def shape(row: AuditRow) -> AuditEntryOut:
    """An entry for the API."""
    return AuditEntryOut(**{name: getattr(row, name) for name in AuditEntryOut.model_fields})


def as_ndjson(
    transaction: Transaction, conditions: Sequence[ColumnElement[bool]], heads: Sequence[SignedHead]
) -> Iterator[bytes]:
    """One entry a line, in the chain's order; then one line for each signed head, under `head`."""
    for row in _rows(transaction, conditions):
        yield shape(row).model_dump_json().encode() + b"\n"
    for head in heads:
        yield json.dumps({"head": head.model_dump(mode="json")}).encode() + b"\n"


def as_fhir(transaction: Transaction, conditions: Sequence[ColumnElement[bool]]) -> Iterator[bytes]:
    """One FHIR R4 Bundle of AuditEvents."""
    yield b'{"resourceType": "Bundle", "type": "collection", "entry": ['
    before = b"\n"
    for row in _rows(transaction, conditions):
        yield before + json.dumps(fhir.entry_of(fhir.audit_event(row))).encode()
        before = b",\n"
    yield b"\n]}\n"


def _rows(transaction: Transaction, conditions: Sequence[ColumnElement[bool]]) -> Iterator[AuditRow]:
    first = 1
    while True:
        with transaction() as database:
            rows = records.entries_from(database, first, BATCH, conditions)
        yield from rows
        if not rows:
            return
        first = rows[-1].number + 1
