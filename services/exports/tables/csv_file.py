"""A table as CSV text: comment lines (#) that define it, one line of names, rows."""

import csv
import io
from collections.abc import Iterable, Iterator
from typing import TextIO

from schemas.payload import Payload
from services.exports.facts import Facts
from services.exports.parameters import ROWS_AT_A_TIME
from services.exports.tables.columns import Cell, Column
from services.exports.tables.kinds import TABLES, Table


class CsvFile:
    """Takes messages as they come. The head is written with the first, for it depends on the body model."""

    def __init__(self, file: TextIO, name: str, facts: Facts) -> None:
        self._table: Table = TABLES[name]
        self._facts = facts
        self._file = file
        self._rows = csv.writer(file)
        self._columns: tuple[Column, ...] | None = None
        self._newest: Payload | None = None

    def take(self, payload: Payload) -> None:
        """One message, of any kind; those of other tables are left out."""
        if not isinstance(payload, self._table.signal.model):
            return
        if self._table.newest_only:
            self._newest = payload
        else:
            self._write(payload)

    def close(self) -> None:
        """Write what had to wait for the end. The file itself stays open."""
        if self._newest is not None:
            self._write(self._newest)
        if self._columns is None:
            self._head(None)

    def calibrated(self, facts: Facts) -> None:
        """More is known of the session; nothing changes once the head is written."""
        self._facts = facts

    def _head(self, first: Payload | None) -> tuple[Column, ...]:
        columns = self._table.columns(first)
        meanings = [f"{column.name}: {column.meaning}" for column in columns if column.meaning]
        lines = [*self._facts.lines(), *self._table.about(first), *meanings]
        self._file.writelines(f"# {line}\n" for line in lines)
        self._rows.writerow([column.name for column in columns])
        self._columns = columns
        return columns

    def _write(self, payload: Payload) -> None:
        columns = self._columns or self._head(payload)
        for entry in self._table.entries(payload):
            self._rows.writerow([_text(column.value(entry)) for column in columns])


def csv_text(name: str, facts: Facts, payloads: Iterable[Payload]) -> Iterator[bytes]:
    """A whole table, in parts, as UTF-8."""
    buffer = io.StringIO(newline="")
    file = CsvFile(buffer, name, facts)
    for payload in payloads:
        file.take(payload)
        if buffer.tell() > 64 * ROWS_AT_A_TIME:
            yield _emptied(buffer)
    file.close()
    yield _emptied(buffer)


def _emptied(buffer: io.StringIO) -> bytes:
    text = buffer.getvalue()
    buffer.seek(0)
    buffer.truncate()
    return text.encode()


def _text(cell: Cell) -> str | int:
    if cell is None:
        return ""
    if isinstance(cell, float):
        return f"{cell:.7g}"
    return str(cell) if isinstance(cell, str) else cell
