"""`manifest.json`: written whole or not at all, and made anew from the files when it is missing."""

from collections.abc import Iterable
from pathlib import Path

from schemas.archive_layout import MANIFEST_FILE, Manifest, RecordingState, SegmentEntry
from schemas.session import SessionDescription
from services.archive.disk import Disk
from services.archive.seal import entry_of
from services.recordings.errors import NotARecording
from services.recordings.folder import segment_files, sha256_of
from services.recordings.segment import scan


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
