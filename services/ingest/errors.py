"""Why a source cannot be read. Each message says where, what is wrong and what to do next."""

from pathlib import Path


class SourceError(ValueError):
    """A source that cannot be used as it is."""


class UnknownSource(SourceError):
    """The specification names nothing that can be opened."""


class MissingFile(SourceError):
    """A file or folder that the specification or the manifest names is not there."""


class InvalidManifest(SourceError):
    """A recording.toml that is not a description of a recording."""


class UnknownUnit(SourceError):
    """A unit that Ambula does not convert."""


class UnknownSegment(SourceError):
    """A body segment that the vocabulary does not have."""


class EmptyFile(SourceError):
    """A file without a single row of data."""


class MissingColumn(SourceError):
    """A column that the manifest names is not in the file."""


class WrongFieldCount(SourceError):
    """Too many rows have more or fewer fields than the header."""


class NotANumber(SourceError):
    """Too many fields that should be numbers are not."""


class UnreadableFile(SourceError):
    """A file that is not text, not gzip, or not what its name promises."""


class WrongUnits(SourceError):
    """Samples that cannot be in the unit that was declared."""


class WrongAxes(SourceError):
    """A camera that cannot look into the room as was declared."""


class ClockError(SourceError):
    """Time stamps that do not advance."""


class InvalidOption(SourceError):
    """An option of a source that is unknown or out of its range."""


def place(path: Path, line: int | None = None, column: str | None = None) -> str:
    """`file, line 12, column acc_x`, as far as known."""
    parts = [path.name]
    if line is not None:
        parts.append(f"line {line}")
    if column is not None:
        parts.append(f"column {column}")
    return ", ".join(parts)
