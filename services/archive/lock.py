"""One archive per data folder: two would take each other's open files for left-overs."""

import fcntl
import os
from pathlib import Path
from typing import Self

from services.recordings.errors import ArchiveError

LOCK_FILE = ".archive.lock"


class DataFolderUnusable(ArchiveError):
    """The folder cannot be written, or another archive records into it."""


class DataFolderLock:
    """Held until `close` or the end of the process, however it ends."""

    def __init__(self, data_dir: Path) -> None:
        try:
            data_dir.mkdir(parents=True, exist_ok=True)
            self._descriptor = os.open(data_dir / LOCK_FILE, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o640)
        except OSError as error:
            raise DataFolderUnusable(f"{error}: set AMBULA_DATA_DIR to a folder that can be written") from error
        try:
            fcntl.flock(self._descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            os.close(self._descriptor)
            raise DataFolderUnusable(
                f"another archive records into {data_dir}: stop it, or set AMBULA_DATA_DIR to another folder"
            ) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._descriptor)
