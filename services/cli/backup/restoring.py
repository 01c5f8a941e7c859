"""Restoring a backup: checked first, beside what is there, and put in place only when all of it is sound."""

import hashlib
import shutil
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath

from services.archive.lock import DataFolderLock
from services.cli.backup import databases
from services.cli.backup.contents import (
    DATABASE,
    DIRECTORY,
    OWN,
    RECORDINGS,
    BackupError,
    Contents,
    KeptFile,
    check,
    read_contents,
)
from services.gateway import revisions
from services.gateway.erasure.tombstones import FILE as ERASURES
from services.gateway.settings import GatewaySettings
from services.recordings.folder import session_folders

STAGE = ".restoring"
BLOCK = 1 << 20
Tell = Callable[[str, int, int], None]


def restore(folder: Path, settings: GatewaySettings, *, replace: bool, tell: Tell) -> Path | None:
    """Put a backup back; where what was there before lies now, None when there was nothing.

    No service may run. Erasures that only this machine knows of are kept; applying them is the caller's next step.
    Raises BackupError, with nothing changed, when the backup is damaged, newer than the software, or something is in
    its way.
    """
    contents = read_contents(folder)
    _check_fits(contents, settings)
    there = _in_the_way(settings, contents)
    if there and not replace:
        raise BackupError(
            f"there is something already: {', '.join(there)}. Name an empty place in AMBULA_DATA_DIR and "
            "AMBULA_DATABASE, or add --replace: what is there is then moved aside, not deleted"
        )
    _check_whole(folder, contents, tell)
    settings.data_dir.mkdir(parents=True, exist_ok=True)
    with DataFolderLock(settings.data_dir):
        stage = settings.data_dir / STAGE
        shutil.rmtree(stage, ignore_errors=True)
        _copy_recordings(folder, contents, stage, tell)
        erased_here = _lines(settings.own_dir / ERASURES)
        aside = _move_aside(settings, contents) if there else None
        for session in sorted(stage.iterdir()) if stage.exists() else []:
            session.rename(settings.data_dir / session.name)
        shutil.rmtree(stage, ignore_errors=True)
        for file in contents.of(OWN):
            _copy(folder, file, settings.own_dir / PurePosixPath(file.path).name, 0o600)
        add_erasures(settings.own_dir / ERASURES, erased_here)
        tell("databases", 0, 1)
        databases.put_back(folder / _one(contents, DATABASE).path, settings.database_url)
        _put_names(folder, contents, settings)
    return aside


def _check_fits(contents: Contents, settings: GatewaySettings) -> None:
    if contents.revision not in revisions.known():
        raise BackupError(f"the backup was made by a newer version ({contents.software}); install that one first")
    wanted = "sqlite" if databases.is_sqlite(settings.database_url) else "postgresql"
    if contents.database != wanted:
        raise BackupError(f"the backup is of {contents.database}, AMBULA_DATABASE names {wanted}; set it accordingly")


def _in_the_way(settings: GatewaySettings, contents: Contents) -> list[str]:
    sessions = len(session_folders(settings.data_dir))
    found = [f"{sessions} recorded sessions in {settings.data_dir}"] if sessions else []
    if not databases.is_empty(settings.database_url):
        found.append("a database of patients and sessions")
    if contents.names and not databases.is_empty(settings.directory_url):
        found.append("a directory of names")
    return found


def _check_whole(folder: Path, contents: Contents, tell: Tell) -> None:
    total, done = sum(file.size_bytes for file in contents.files), 0

    def count(size: int) -> None:
        nonlocal done
        done += size
        tell("checking", done, total)

    check(folder, contents, count)


def _copy_recordings(folder: Path, contents: Contents, stage: Path, tell: Tell) -> None:
    files = contents.of(RECORDINGS)
    total, done = sum(file.size_bytes for file in files), 0
    for file in files:
        _, session, name = PurePosixPath(file.path).parts
        (stage / session).mkdir(parents=True, exist_ok=True)
        _copy(folder, file, stage / session / name, 0o640)
        done += file.size_bytes
        tell("recordings", done, total)


def _copy(folder: Path, file: KeptFile, target: Path, mode: int) -> None:
    """Copy, and compare the checksum of what was written."""
    digest = hashlib.sha256()
    target.parent.mkdir(parents=True, exist_ok=True)
    target.touch(mode=mode)
    with (folder / file.path).open("rb") as source, target.open("wb") as to:
        while block := source.read(BLOCK):
            digest.update(block)
            to.write(block)
    if digest.hexdigest() != file.sha256:
        raise BackupError(f"{file.path} changed while it was read; is the disk sound?")


def _move_aside(settings: GatewaySettings, contents: Contents) -> Path:
    aside = settings.data_dir / f"replaced-{datetime.now(UTC):%Y%m%dT%H%M%SZ}"
    aside.mkdir(mode=0o700)
    for session in session_folders(settings.data_dir):
        session.rename(aside / session.name)
    if not databases.is_empty(settings.database_url):
        databases.clear(settings.database_url, aside)
    if contents.names and not databases.is_empty(settings.directory_url):
        databases.clear(settings.directory_url, aside)
        if settings.directory_key.exists():
            # Names without the key that sealed them would be lost.
            shutil.move(settings.directory_key, aside / settings.directory_key.name)
    for file in contents.of(OWN):
        own = settings.own_dir / PurePosixPath(file.path).name
        if own.exists():
            shutil.move(own, aside / own.name)
    return aside


def add_erasures(file: Path, others: list[str]) -> None:
    """Add the lines of another list that are not in this one: who was erased after the backup stays so."""
    lines = _lines(file)
    new = [line for line in others if line not in lines]
    if new:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.touch(mode=0o600)
        file.write_text("".join(f"{line}\n" for line in (*lines, *new)), encoding="utf-8")


def _lines(file: Path) -> list[str]:
    return [line for line in file.read_text(encoding="utf-8").splitlines() if line.strip()] if file.exists() else []


def _put_names(folder: Path, contents: Contents, settings: GatewaySettings) -> None:
    for file in contents.of(DIRECTORY):
        path = PurePosixPath(file.path)
        if path.suffix in (".sqlite", ".dump"):
            databases.put_back(folder / file.path, settings.directory_url)
        else:
            _copy(folder, file, settings.directory_key, 0o600)


def _one(contents: Contents, part: str) -> KeptFile:
    (file,) = contents.of(part)
    return file
