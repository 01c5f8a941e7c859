"""Making a backup: the databases as of one moment, then every closed recording that is not there yet."""

import hashlib
import os
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath

from schemas.archive_layout import CHECKPOINT_PREFIX, MANIFEST_FILE, PART_SUFFIX
from services.cli.backup import databases
from services.cli.backup.contents import (
    DATABASE,
    DIRECTORY,
    OWN,
    RECORDINGS,
    BackupError,
    Contents,
    KeptFile,
    read_contents,
    write_contents,
)
from services.flow.software import SOFTWARE
from services.gateway import revisions
from services.gateway.audit.heads import HEADS_FILE, KEY_FILE
from services.gateway.erasure.tombstones import FILE as ERASURES
from services.gateway.settings import GatewaySettings
from services.recordings.folder import session_folders

OWN_FILES = (ERASURES, HEADS_FILE, KEY_FILE)
"""What only the gateway has: whom to forget again, and where the audit ended."""
BLOCK = 1 << 20
Tell = Callable[[str, int, int], None]
"""What is done, bytes done, bytes in all."""


@dataclass
class Made:
    """A finished backup, and how much of it is new."""

    contents: Contents
    copied_bytes: int = 0
    forgotten: list[str] = field(default_factory=list)


def make_backup(folder: Path, settings: GatewaySettings, *, names: bool, tell: Tell) -> Made:
    """Bring a backup up to date, or begin one. Services may run. Raises BackupError, OSError.

    What was erased since goes from the backup, too; a recording that is only missing stays.
    """
    before = _before(folder)
    made_at = datetime.now(UTC)
    stamp = made_at.strftime("%Y%m%dT%H%M%SZ")
    revision = _revision(settings)
    tell("databases", 0, 1)
    files = [_database(folder, DATABASE, settings.database_url, stamp)]
    if names:
        files += _names(folder, settings, stamp)
    own = [settings.own_dir / name for name in OWN_FILES]
    files += [_copied(path, folder, f"{OWN}/{path.name}") for path in own if path.exists()]
    recordings, copied_bytes = _recordings(folder, settings.data_dir, before, tell)
    kept, forgotten = _still_known(before, recordings, databases.sessions_in(settings.database_url))
    contents = Contents(
        made=made_at, software=SOFTWARE, revision=revision,
        database="sqlite" if databases.is_sqlite(settings.database_url) else "postgresql", names=names,
        files=[*files, *recordings, *kept],
    )  # fmt: skip
    write_contents(folder, contents)
    _sweep(folder, contents)
    return Made(contents, copied_bytes, forgotten)


def _before(folder: Path) -> Contents | None:
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    try:
        return read_contents(folder)
    except BackupError:
        if any(each.name not in (DATABASE, DIRECTORY, OWN, RECORDINGS) for each in folder.iterdir()):
            raise BackupError(f"{folder} holds something else than a backup; name an empty folder") from None
        return None


def _revision(settings: GatewaySettings) -> str:
    revision = revisions.present(settings.database_url)
    if revision is None:
        raise BackupError("the database has no tables yet; start the gateway once, then make a backup")
    return revision


def _database(folder: Path, part: str, url: str, stamp: str) -> KeptFile:
    suffix = "sqlite" if databases.is_sqlite(url) else "dump"
    target = folder / part / f"{part}-{stamp}.{suffix}"
    target.parent.mkdir(exist_ok=True, mode=0o700)
    target.unlink(missing_ok=True)
    databases.copy(url, target)
    return _entry(target, f"{part}/{target.name}", target.stat().st_mtime_ns)


def _names(folder: Path, settings: GatewaySettings, stamp: str) -> list[KeptFile]:
    """Names and the key that opens them. Nobody has any as long as there is no key."""
    if not settings.directory_key.exists():
        return []
    key = _copied(settings.directory_key, folder, f"{DIRECTORY}/{settings.directory_key.name}")
    return [_database(folder, DIRECTORY, settings.directory_url, stamp), key]


def _recordings(folder: Path, data_dir: Path, before: Contents | None, tell: Tell) -> tuple[list[KeptFile], int]:
    known = {} if before is None else {file.path: file for file in before.of(RECORDINGS)}
    found = [(path, f"{RECORDINGS}/{path.parent.name}/{path.name}") for path in _closed_files(data_dir)]
    new = {name for path, name in found if not _is_unchanged(path, known.get(name), folder)}
    total = sum(path.stat().st_size for path, name in found if name in new)
    done, files = 0, []
    for path, name in found:
        if name not in new:
            files.append(known[name])
            continue
        files.append(_copied(path, folder, name))
        done += files[-1].size_bytes
        tell("recordings", done, total)
    return files, done


def _closed_files(data_dir: Path) -> Iterator[Path]:
    """Of each session its manifest first: what it names is closed, and is still there when its turn comes."""
    for session in session_folders(data_dir):
        paths = [path for path in session.iterdir() if path.is_file() and not path.is_symlink()]
        closed = [path for path in paths if path.suffix not in (PART_SUFFIX, ".tmp")]
        closed = [path for path in closed if not path.name.startswith(CHECKPOINT_PREFIX)]
        yield from sorted(closed, key=lambda path: (path.name != MANIFEST_FILE, path.name))


def _is_unchanged(path: Path, known: KeptFile | None, folder: Path) -> bool:
    facts = path.stat()
    if known is None or (known.size_bytes, known.changed_ns) != (facts.st_size, facts.st_mtime_ns):
        return False
    kept = folder / known.path
    return kept.is_file() and kept.stat().st_size == known.size_bytes


def _copied(path: Path, folder: Path, name: str) -> KeptFile:
    """Copy a file, its checksum taken of the bytes that were read."""
    target = folder / name
    target.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    draft = target.with_name(target.name + ".tmp")
    digest, changed_ns = hashlib.sha256(), path.stat().st_mtime_ns
    with path.open("rb") as source, os.fdopen(os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "wb") as to:
        while block := source.read(BLOCK):
            digest.update(block)
            to.write(block)
        to.flush()
        os.fsync(to.fileno())
        size = to.tell()
    draft.replace(target)
    return KeptFile(path=name, size_bytes=size, sha256=digest.hexdigest(), changed_ns=changed_ns)


def _entry(path: Path, name: str, changed_ns: int) -> KeptFile:
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return KeptFile(path=name, size_bytes=path.stat().st_size, sha256=digest, changed_ns=changed_ns)


def _still_known(
    before: Contents | None, recordings: list[KeptFile], known: set[str]
) -> tuple[list[KeptFile], list[str]]:
    """Files that have gone from the archive: those of sessions the database knows stay, the others were erased."""
    present = {file.path for file in recordings}
    gone = [] if before is None else [file for file in before.of(RECORDINGS) if file.path not in present]
    kept = [file for file in gone if _session(file) in known]
    return kept, sorted({_session(file) for file in gone} - {_session(file) for file in (*recordings, *kept)})


def _session(file: KeptFile) -> str:
    return PurePosixPath(file.path).parts[1]


def _sweep(folder: Path, contents: Contents) -> None:
    """Remove what the list does not name any more."""
    named = {folder / file.path for file in contents.files}
    for part in (DATABASE, DIRECTORY, OWN, RECORDINGS):
        for path in sorted((folder / part).rglob("*"), reverse=True):
            if path.is_dir():
                if not any(path.iterdir()):
                    path.rmdir()
            elif path not in named:
                path.unlink()
        if (folder / part).is_dir() and not any((folder / part).iterdir()):
            shutil.rmtree(folder / part)
