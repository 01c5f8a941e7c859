"""What was recomputed, on the disk beside the older files and in the database in place of the older result."""

import fcntl
import os
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from schemas.archive_layout import SegmentName
from schemas.metrics import SessionMetrics
from schemas.session import SessionDescription
from services.archive.disk import Disk
from services.archive.manifest import store, with_unlisted
from services.archive.parameters import PARAMETERS
from services.archive.seal import seal
from services.archive.writer import SessionWriter
from services.cli.reprocess.recompute import CannotRecompute
from services.flow.software import SOFTWARE, VERSION
from services.gateway.access.scope import EVERYTHING
from services.gateway.database import Database, open_database
from services.gateway.settings import GatewaySettings
from services.gateway.versions.records import replace_metrics
from services.recordings.folder import read_manifest
from services.recordings.record import Record

WORK_FOLDER = ".reprocess"
"""Inside the session's folder, so that a rename can finish the work. What a kill leaves there is nothing yet."""


class DerivedFile:
    """`derived-VERSION.mcap` of a session, whole or not there. Never in place of another."""

    def __init__(self, folder: Path, description: SessionDescription) -> None:
        self._folder = folder
        self._work = folder / WORK_FOLDER
        self._disk = Disk()
        self._writer = SessionWriter(self._work, description, VERSION)
        self._waiting = 0

    @classmethod
    @contextmanager
    def begun(cls, folder: Path, description: SessionDescription) -> Iterator["DerivedFile"]:
        """A draft that nobody else works on; swept away at the end. Raises CannotRecompute, OSError."""
        work = folder / WORK_FOLDER
        work.mkdir(exist_ok=True)
        descriptor = os.open(work, os.O_RDONLY | os.O_DIRECTORY)
        try:
            try:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError as error:
                raise CannotRecompute("is being recomputed by another process; wait until that has ended") from error
            for left in work.iterdir():
                left.unlink()
            file = cls(folder, description)
            try:
                yield file
            finally:
                file._writer.close()
                shutil.rmtree(work)
        finally:
            os.close(descriptor)

    def add(self, record: Record) -> None:
        """Take the next message."""
        self._writer.write(record._replace(received_unix_ns=time.time_ns()))
        self._waiting += 1
        if self._waiting == 1000:
            self._writer.push()
            self._waiting = 0

    def finish(self) -> str:
        """Close the file, give it its name and list it in the manifest; the name.

        Raises FileExistsError when there is one of that name, OSError.
        """
        self._writer.flush()
        for part in self._writer.close():
            seal(part, SOFTWARE, self._disk, PARAMETERS.chunk_bytes)
        name = SegmentName("derived", VERSION, 0, part=False).file_name
        os.link(self._work / name, self._folder / name)
        self._disk.sync_folder(self._folder)
        list_files(self._folder)
        return name


def list_files(folder: Path) -> None:
    """See that the manifest names every closed file of the folder. Raises OSError."""
    manifest = read_manifest(folder)
    if manifest is not None and (listed := with_unlisted(folder, manifest)) != manifest:
        store(folder, listed, Disk())


class Index:
    """The gateway's database: what its pages show of a session."""

    def __init__(self, database: Database) -> None:
        self._database = database

    @classmethod
    @contextmanager
    def opened(cls, data_dir: Path) -> Iterator["Index | None"]:
        """The database of the settings, or in the data folder; None where there is none yet. Raises DatabaseError."""
        settings = GatewaySettings(data_dir=data_dir)
        if not settings.database and not (data_dir / "ambula.sqlite").exists():
            yield None
            return
        database = open_database(settings.database_url)
        try:
            yield cls(database)
        finally:
            database.close()

    def replace(self, description: SessionDescription, metrics: SessionMetrics) -> bool:
        """Put a result in place of the current one, which is kept. False when the session is not known there."""
        with self._database.transaction(EVERYTHING) as transaction:
            return replace_metrics(transaction, description.session, metrics, description)
