"""`backup.json`: what a backup holds, with the checksum of every file. Written last, so that what it names is there."""

import os
from collections.abc import Callable
from datetime import datetime
from pathlib import Path, PurePosixPath
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

from services.recordings.folder import sha256_of

FILE = "backup.json"
FORMAT: Literal[1] = 1
DATABASE, DIRECTORY, OWN, RECORDINGS = "database", "directory", "own", "recordings"
"""The folders of a backup: index of patients and sessions; names; the gateway's own files; one folder per session."""


class BackupError(RuntimeError):
    """A backup cannot be made or restored; says what to do."""


def _inside(path: str) -> str:
    parts = PurePosixPath(path).parts
    if not 2 <= len(parts) <= 3 or parts[0] not in (DATABASE, DIRECTORY, OWN, RECORDINGS) or ".." in parts:
        raise ValueError("a file of a backup lies in one of its folders")
    return path


class KeptFile(BaseModel):
    """One file; `changed_ns`: when its original was last written, by which an unchanged one is known."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    path: Annotated[str, AfterValidator(_inside)]
    size_bytes: int = Field(ge=0)
    sha256: str
    changed_ns: int

    @property
    def folder(self) -> str:
        """Which part of the backup it belongs to."""
        return PurePosixPath(self.path).parts[0]


class Contents(BaseModel):
    """A whole backup. `revision`: schema of the database; `names`: whether the directory of names is in it."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    format: Literal[1] = FORMAT
    made: datetime
    software: str
    revision: str
    database: Literal["sqlite", "postgresql"]
    names: bool
    files: list[KeptFile]

    def of(self, folder: str) -> list[KeptFile]:
        """Files of one part."""
        return [file for file in self.files if file.folder == folder]


def read_contents(folder: Path) -> Contents:
    """Raises BackupError when the folder is no backup, or one that was cut short."""
    try:
        return Contents.model_validate_json((folder / FILE).read_bytes())
    except FileNotFoundError as error:
        raise BackupError(f"{folder} holds no {FILE}: it is no backup, or one that was never finished") from error
    except (ValidationError, OSError) as error:
        raise BackupError(f"{folder / FILE} cannot be read; take an older copy of the folder") from error


def write_contents(folder: Path, contents: Contents) -> None:
    """Replace the list, whole or not at all."""
    draft = folder / f"{FILE}.tmp"
    with draft.open("w", encoding="utf-8") as file:
        file.write(contents.model_dump_json(indent=1))
        file.flush()
        os.fsync(file.fileno())
    draft.replace(folder / FILE)


def check(folder: Path, contents: Contents, tell: Callable[[int], None]) -> None:
    """Compare every file with its checksum, telling bytes. Raises BackupError with what differs."""
    wrong = []
    for file in contents.files:
        path = folder / file.path
        if not path.is_file():
            wrong.append(f"{file.path} is missing")
        elif path.stat().st_size != file.size_bytes or sha256_of(path) != file.sha256:
            wrong.append(f"{file.path} was altered")
        tell(file.size_bytes)
    if wrong:
        shown = "; ".join(wrong[:5]) + (f"; and {len(wrong) - 5} more" if len(wrong) > 5 else "")
        raise BackupError(f"the backup is damaged, nothing was restored: {shown}. Take an older one.")
