"""`manifest.json`: read, written whole or not at all, and made anew from the files when it is missing."""

import hashlib
from collections.abc import Iterable
from pathlib import Path

from pydantic import ValidationError

from schemas.archive_layout import MANIFEST_FILE, Manifest, RecordingState, SegmentEntry, SegmentName, parse_file_name
from schemas.session import SessionDescription
from services.archive.disk import Disk
from services.archive.errors import NotARecording
from services.archive.ledger import Ledger
from services.archive.seal import entry_of
from services.archive.segment import scan

_HASH_BLOCK = 1 << 20


def segment_files(folder: Path) -> list[tuple[SegmentName, Path]]:
    """The files of a session, closed or open, raw first, in the order in which they were recorded."""
    named = ((parse_file_name(path.name), path) for path in folder.iterdir() if path.is_file())
    found = [(name, path) for name, path in named if name is not None]
    return sorted(found, key=lambda item: (item[0].version or "", item[0].number, item[0].part))


def new_manifest(description: SessionDescription, derived_version: str) -> Manifest:
    """A recording that has just begun."""
    return Manifest(
        session=description.session,
        title=description.title,
        protocol=description.protocol,
        origin=description.origin,
        estimator=description.estimator,
        started_unix_ns=description.started_unix_ns,
        duration_s=0.0,
        state=RecordingState.RECORDING,
        state_reason=None,
        derived_version=derived_version,
        files=[],
    )


def with_files(manifest: Manifest, entries: Iterable[SegmentEntry]) -> Manifest:
    """The manifest with more (or newer) files; the duration follows."""
    files = {entry.name: entry for entry in (*manifest.files, *entries)}
    captured = [span.last_captured_ns for entry in files.values() for span in entry.streams]
    return manifest.model_copy(update={"files": list(files.values()), "duration_s": max([0, *captured]) / 1e9})


def with_state(manifest: Manifest, state: RecordingState, reason: str | None = None) -> Manifest:
    """The manifest of a recording that has come to another state."""
    return manifest.model_copy(update={"state": state, "state_reason": reason})


def store(folder: Path, manifest: Manifest, disk: Disk) -> None:
    """Replace the session's manifest. Raises OSError; the old one is then still there."""
    disk.replace_with(folder / MANIFEST_FILE, manifest.model_dump_json(indent=1).encode())


def load(folder: Path) -> Manifest | None:
    """The manifest of a folder; None when there is none or it cannot be read."""
    try:
        return Manifest.model_validate_json((folder / MANIFEST_FILE).read_bytes())
    except (FileNotFoundError, ValidationError):
        return None


def rebuild(folder: Path, derived_version: str) -> Manifest:
    """Make the manifest from the files. Raises NotARecording when none of them names the session.

    `derived_version` counts when there is no derived file, or several versions and this is one of them.
    """
    manifest = None
    entries = []
    files = segment_files(folder)
    versions = {name.version for name, _ in files if name.version is not None} or {derived_version}
    version = derived_version if derived_version in versions else min(versions)
    for name, path in files:
        found = scan(path)
        if found.description is not None:
            manifest = manifest or new_manifest(found.description, version)
            if not name.part:
                entries.append(entry_of(found, sha256_of(path), path.stat().st_size))
    if manifest is None:
        raise NotARecording(f"{folder.name} holds no file of a recorded session")
    return with_state(with_files(manifest, entries), RecordingState.INTERRUPTED)


def with_unlisted(folder: Path, manifest: Manifest) -> Manifest:
    """The manifest with files that were closed just before it could be written."""
    listed = {entry.name for entry in manifest.files}
    unlisted = [path for name, path in segment_files(folder) if not name.part and name.file_name not in listed]
    return with_files(manifest, (entry_of(scan(path), sha256_of(path), path.stat().st_size) for path in unlisted))


def sha256_of(path: Path) -> str:
    """Hexadecimal digest of a file."""
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(_HASH_BLOCK):
            digest.update(block)
    return digest.hexdigest()


def ledger_of(manifest: Manifest) -> Ledger:
    """What the closed files of the live recording hold of each stream."""
    ledger = Ledger()
    for entry in manifest.files:
        name = parse_file_name(entry.name)
        if name is not None and name.version in (None, manifest.derived_version):
            ledger.absorb(entry.streams)
    return ledger
