"""Number columns out of a MATLAB file of version 5: a column is called variable.field.number, or variable.number.

Numbers count from 1, as MATLAB counts; a vector has the one column 1.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.io import loadmat

from services.ingest.errors import EmptyFile, MissingColumn, UnreadableFile, WrongFieldCount, place


def read_columns(path: Path, columns: Sequence[str]) -> NDArray[np.float64]:
    """The named columns, n x columns; not a number where the file says so.

    Raises:
        FileNotFoundError: there is no such file.
        SourceError: the file is damaged, or a column is missing or of another length.
    """
    found = _read(path)
    taken = [_column(path, found, name) for name in columns]
    lengths = {len(column) for column in taken}
    if len(lengths) > 1:
        raise WrongFieldCount(f"{place(path)}: the columns {', '.join(columns)} have {sorted(lengths)} rows")
    if not taken or lengths == {0}:
        raise EmptyFile(f"{place(path)}: no rows; export it again")
    return np.stack(taken, axis=1)


def _read(path: Path) -> dict[str, Any]:
    with path.open("rb") as file:
        try:
            contents: dict[str, Any] = loadmat(file, squeeze_me=True, struct_as_record=False)
        except Exception as error:  # scipy raises whatever its parser stumbles over
            raise UnreadableFile(f"{place(path)}: {error}; the file is damaged or not MATLAB's version 5") from error
    return contents


def _column(path: Path, contents: dict[str, Any], name: str) -> NDArray[np.float64]:
    *way, number = name.split(".")
    value: Any = contents
    for step in way:
        known = list(value) if isinstance(value, dict) else list(getattr(value, "_fieldnames", []))
        if step not in known or step.startswith("_"):
            names = ", ".join(each for each in known if not each.startswith("_"))
            raise MissingColumn(f"{place(path)}: no {step!r} in column {name!r}; there are {names or 'no fields'}")
        value = value[step] if isinstance(value, dict) else getattr(value, step)
    table = np.asarray(value)
    if not way or table.dtype.kind not in "fiub" or table.ndim not in (1, 2):
        raise MissingColumn(f"{place(path)}: column {name!r} is no table of numbers; write variable.field.number")
    rows = table[:, None] if table.ndim == 1 else table
    if not number.isascii() or not number.isdecimal() or not 1 <= int(number) <= rows.shape[1]:
        raise MissingColumn(f"{place(path)}: column {name!r} counts from 1 to {rows.shape[1]}")
    return np.asarray(rows[:, int(number) - 1], dtype=np.float64)
