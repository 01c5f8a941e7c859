"""A session's folder: which files are in it, what its manifest says of them, and whether they are as they were."""

import hashlib
from pathlib import Path

from pydantic import ValidationError

from schemas.archive_layout import MANIFEST_FILE, Manifest, SegmentName, parse_file_name
from services.recordings.ledger import Ledger

_HASH_BLOCK = 1 << 20


def session_folders(data_dir: Path) -> list[Path]:
    """Folders that hold, or could hold, a session."""
    if not data_dir.is_dir():
        return []
    return sorted(folder for folder in data_dir.iterdir() if folder.is_dir() and _looks_recorded(folder))


def segment_files(folder: Path) -> list[tuple[SegmentName, Path]]:
    """The files of a session, closed or open, raw first, in the order in which they were recorded."""
    named = ((parse_file_name(path.name), path) for path in folder.iterdir() if path.is_file())
    found = [(name, path) for name, path in named if name is not None]
    return sorted(found, key=lambda item: (item[0].version or "", item[0].number, item[0].part))


def derived_versions(folder: Path) -> list[str]:
    """Versions of which there are closed derived files, the one written live first, then in the order they were stored.

    Where no manifest tells the order, by name.
    """
    found = {name.version for name, _ in segment_files(folder) if name.version is not None and not name.part}
    manifest = read_manifest(folder)
    told = [] if manifest is None else [parse_file_name(entry.name) for entry in manifest.files]
    live = [] if manifest is None else [manifest.derived_version]
    listed = dict.fromkeys([*live, *(name.version for name in told if name is not None and name.version is not None)])
    return [version for version in (*listed, *sorted(found - listed.keys())) if version in found]


def read_manifest(folder: Path) -> Manifest | None:
    """The manifest of a folder; None when there is none or it cannot be read."""
    try:
        return Manifest.model_validate_json((folder / MANIFEST_FILE).read_bytes())
    except (FileNotFoundError, ValidationError):
        return None


def ledger_of(manifest: Manifest) -> Ledger:
    """What the closed files of the live recording hold of each stream."""
    ledger = Ledger()
    for entry in manifest.files:
        name = parse_file_name(entry.name)
        if name is not None and name.version in (None, manifest.derived_version):
            ledger.absorb(entry.streams)
    return ledger


def verify(folder: Path) -> list[str]:
    """Compare every closed file with the manifest's checksum; what differs, in words."""
    manifest = read_manifest(folder)
    if manifest is None:
        return [f"{folder.name}: no readable manifest; restart the archive to have it made anew"]
    differing = []
    for entry in manifest.files:
        path = folder / entry.name
        if not path.exists():
            differing.append(f"{entry.name}: missing; restore it from a backup")
        elif sha256_of(path) != entry.sha256:
            differing.append(f"{entry.name}: altered since it was closed; restore it from a backup")
    return differing


def sha256_of(path: Path) -> str:
    """Hexadecimal digest of a file."""
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(_HASH_BLOCK):
            digest.update(block)
    return digest.hexdigest()


def _looks_recorded(folder: Path) -> bool:
    return (folder / MANIFEST_FILE).exists() or any(folder.glob("*.mcap*"))
