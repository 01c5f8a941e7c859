"""Number columns out of a csv, csv.gz or mat file. A bad row is counted, many are an error that names the place."""

import csv
import difflib
import gzip
import math
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TextIO, cast

import numpy as np
from numpy.typing import NDArray

from services.ingest.errors import (
    EmptyFile,
    MissingColumn,
    MissingFile,
    NotANumber,
    UnreadableFile,
    WrongFieldCount,
    place,
)
from services.ingest.matlab import read_columns

MOST_BAD_SHARE = 0.01
"""Share of malformed rows above which a file is refused; one bad row is always forgiven."""

MATLAB_SUFFIX = ".mat"

MISSING_WORDS = frozenset({"", "na", "n/a", "null", "none", "-"})
"""Fields that say `no value`, besides nan and inf. Not an error: radios lose samples, cameras lose markers."""


@dataclass(frozen=True, slots=True)
class CsvFormat:
    """How a text table is written. Without a header the columns are called 1, 2, 3, ..."""

    delimiter: str = ","
    header: bool = True
    skip_lines: int = 0


@dataclass(frozen=True, slots=True)
class Table:
    """`values` n x columns, NaN where the field said `no value`; `rows` n, index of each row among the file's data."""

    path: Path
    columns: tuple[str, ...]
    rows: NDArray[np.int64]
    values: NDArray[np.float64]
    malformed: int


@dataclass
class _BadRows:
    """What was wrong, and where it first was."""

    count: int = 0
    first: WrongFieldCount | NotANumber | None = None
    width: int = 0
    names: tuple[str, ...] = ()
    path: Path = field(default_factory=Path)

    def wrong_count(self, line: int, found: int) -> None:
        self.count += 1
        if self.first is None:
            where = place(self.path, line)
            self.first = WrongFieldCount(f"{where}: {found} fields where {self.width} are expected")

    def not_a_number(self, line: int, name: str, text: str) -> None:
        self.count += 1
        if self.first is None:
            where = place(self.path, line, name)
            self.first = NotANumber(f"{where}: {text[:40]!r} is not a number")

    def refuse_if_many(self, rows: int) -> None:
        if self.first is not None and self.count > max(1, MOST_BAD_SHARE * rows):
            raise type(self.first)(
                f"{self.first}; {self.count} of {rows} rows are malformed: check delimiter, skip_lines and columns"
            )


def read_table(path: Path, columns: Sequence[str], layout: CsvFormat = CsvFormat()) -> Table:
    """Read the named columns. Raises a SourceError that names file, line and column."""
    try:
        if path.suffix == MATLAB_SUFFIX:
            values = read_columns(path, columns)
            values[~np.isfinite(values)] = np.nan
            return Table(path, tuple(columns), np.arange(len(values)), values, 0)
        with _open_text(path) as text:
            return _read(path, text, columns, layout)
    except FileNotFoundError as error:
        raise MissingFile(f"no file {path}; correct `file` or `data` in recording.toml") from error
    except (OSError, EOFError, zlib.error, UnicodeDecodeError, csv.Error) as error:
        raise UnreadableFile(f"{place(path)}: {error}; the file is damaged or not a csv table") from error


def _open_text(path: Path) -> TextIO:
    if path.suffix == ".gz":
        return cast(TextIO, gzip.open(path, "rt", encoding="utf-8-sig", newline=""))
    return path.open(encoding="utf-8-sig", newline="")


def _read(path: Path, text: TextIO, columns: Sequence[str], layout: CsvFormat) -> Table:
    for _ in range(layout.skip_lines):
        text.readline()
    reader = csv.reader(text, delimiter=layout.delimiter, strict=True)
    body = _Body(reader, layout.skip_lines)
    first = next(body.rows(), None)
    if first is None:
        raise EmptyFile(f"{place(path)}: the file is empty; export it again")
    names = [name.strip() for name in first] if layout.header else [str(i + 1) for i in range(len(first))]
    indices = [_index_of(path, names, column) for column in columns]
    bad = _BadRows(width=len(names), names=tuple(columns), path=path)
    if not layout.header:
        body.put_back(first)
    rows, values, count = _collect(body, indices, bad)
    if count == 0:
        raise EmptyFile(f"{place(path)}: no rows after the header; export it again")
    bad.refuse_if_many(count)
    flat = np.array(values, dtype=np.float64).reshape(len(rows), len(columns))
    flat[~np.isfinite(flat)] = np.nan
    return Table(path, tuple(columns), np.array(rows, dtype=np.int64), flat, bad.count)


class _Body:
    """Non-empty rows with their line numbers, one of which may be put back."""

    def __init__(self, reader: Iterator[list[str]], skipped: int) -> None:
        self._reader = reader
        self._skipped = skipped
        self._again: list[str] | None = None

    @property
    def line(self) -> int:
        return self._skipped + int(getattr(self._reader, "line_num", 0))

    def put_back(self, row: list[str]) -> None:
        self._again = row

    def rows(self) -> Iterator[list[str]]:
        if self._again is not None:
            row, self._again = self._again, None
            yield row
        for row in self._reader:
            if row:
                yield row


def _index_of(path: Path, names: list[str], column: str) -> int:
    if column in names:
        return names.index(column)
    close = difflib.get_close_matches(column, names, n=3)
    hint = f"did you mean {', '.join(close)}?" if close else f"it has {', '.join(names[:12])}"
    raise MissingColumn(f"{place(path)}: no column {column!r}; {hint}")


def _collect(body: _Body, indices: list[int], bad: _BadRows) -> tuple[list[int], list[list[float]], int]:
    rows: list[int] = []
    values: list[list[float]] = []
    count = 0
    for count, fields in enumerate(body.rows(), start=1):
        if len(fields) != bad.width:
            bad.wrong_count(body.line, len(fields))
            continue
        try:
            numbers = [float(fields[i]) for i in indices]
        except ValueError:
            repaired = _with_missing(fields, indices, body.line, bad)
            if repaired is None:
                continue
            numbers = repaired
        rows.append(count - 1)
        values.append(numbers)
    return rows, values, count


def _with_missing(fields: list[str], indices: list[int], line: int, bad: _BadRows) -> list[float] | None:
    numbers: list[float] = []
    for name, i in zip(bad.names, indices, strict=True):
        if fields[i].strip().lower() in MISSING_WORDS:
            numbers.append(math.nan)
            continue
        try:
            numbers.append(float(fields[i]))
        except ValueError:
            bad.not_a_number(line, name, fields[i])
            return None
    return numbers
