"""Numbers as lines of text."""

from collections.abc import Sequence

from services.exports.motion import Array

DECIMALS = 8


def rows_of_numbers(rows: Array) -> bytes:
    """(n, m) numbers, eight decimals, tabs between them, a line each."""
    line = "\t".join([f"%.{DECIMALS}f"] * rows.shape[1])
    return "".join(f"{line}\n" % tuple(row) for row in rows.tolist()).encode("ascii")


def cells(numbers: Sequence[float], told: bool) -> str:
    """Numbers between tabs with five decimals, or as many empty cells."""
    return "\t".join(f"{number:.5f}" if told else "" for number in numbers)
