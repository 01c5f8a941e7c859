"""The list of what was erased: applied again at every start, so that a restored backup brings nobody back.

A line names nobody: a digest of the patient code, ids of sessions, when, by which account, and why as a word.
"""

import fcntl
import hashlib
import os
from datetime import datetime
from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field, ValidationError

FILE = "erasures.jsonl"


class Tombstone(BaseModel):
    """One erasure. Without a patient: sessions whose time was over."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    patient_sha256: str | None = Field(description="of the patient code, hexadecimal")
    name_place: str | None = Field(description="where the directory held the name; null when it held none")
    sessions: list[str]
    at: datetime
    by: str = Field(description="id of the account, or housekeeping")
    reason: str


class TombstonesUnreadable(RuntimeError):
    """A line of the list is not one; says which."""


def digest_of(code: str) -> str:
    """How a patient code stands in the list."""
    return hashlib.sha256(code.encode()).hexdigest()


class Tombstones:
    """The file in the gateway's own folder; several gateways may write it."""

    def __init__(self, folder: Path) -> None:
        self.file = folder / FILE

    def add(self, *tombstones: Tombstone) -> None:
        """Write them down, on the disk before it returns. Raises OSError."""
        self.file.parent.mkdir(parents=True, exist_ok=True)
        with self.file.open("a", encoding="utf-8") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            file.write("".join(tombstone.model_dump_json() + "\n" for tombstone in tombstones))
            file.flush()
            os.fsync(file.fileno())

    def read(self) -> list[Tombstone]:
        """All of them, oldest first. Raises TombstonesUnreadable."""
        return parsed(self.file.read_text(encoding="utf-8")) if self.file.exists() else []


def parsed(text: str) -> list[Tombstone]:
    """The lines of a list. A last line that a power cut left unfinished is left out. Raises TombstonesUnreadable."""
    lines = text.split("\n")
    found = []
    for number, line in enumerate(lines[:-1], 1):
        try:
            found.append(Tombstone.model_validate_json(line))
        except ValidationError as error:
            raise TombstonesUnreadable(
                f"line {number} of {FILE} is not an erasure; compare it with a backup"
            ) from error
    return found
