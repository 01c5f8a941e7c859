"""After a start: what each unfinished recording already holds, so that it can go on without a hole."""

from dataclasses import dataclass
from pathlib import Path

from schemas.archive_layout import Manifest, parse_file_name
from schemas.session import SessionDescription
from services.archive.disk import Disk
from services.archive.manifest import (
    new_manifest,
    rebuild,
    store,
    with_unlisted,
)
from services.archive.seal import SEALING_SUFFIX
from services.recordings.errors import NotARecording
from services.recordings.folder import ledger_of, read_manifest, segment_files
from services.recordings.ledger import Ledger
from services.recordings.segment import scan


@dataclass
class Recovered:
    """A session folder brought in order.

    `ledger` is what is safely held, open files included; `parts` are the open files, which wait to be sealed;
    `next_number` is the number of the next file.
    """

    folder: Path
    manifest: Manifest
    ledger: Ledger
    parts: list[Path]
    next_number: int


def recover(folder: Path, description: SessionDescription | None, derived_version: str, disk: Disk) -> Recovered | None:
    """Take stock of a session folder and remove what half-done work left; nothing that was recorded is touched.

    `description` and `derived_version` are for a recording that only begins: one that goes on keeps its version,
    so that its files belong together. Returns None when there is nothing and no description. Raises OSError.
    """
    _sweep(folder, disk)
    manifest = read_manifest(folder)
    if manifest is None and any(folder.glob("*.mcap*")):
        manifest = _rebuilt(folder, derived_version, disk)
    if manifest is None and description is not None:
        manifest = new_manifest(description, derived_version)
    if manifest is None:
        return None
    manifest = with_unlisted(folder, manifest)
    ledger = ledger_of(manifest)
    parts = [path for name, path in segment_files(folder) if name.part]
    for part in parts:
        name = parse_file_name(part.name)
        if name is not None and name.version in (None, manifest.derived_version):
            ledger.absorb(scan(part).ledger.spans())
    return Recovered(folder, manifest, ledger, parts, _next_number(folder))


def _sweep(folder: Path, disk: Disk) -> None:
    """Drafts are not yet anything; an open file whose closed twin exists has been copied in full."""
    for draft in (*folder.glob(f"*{SEALING_SUFFIX}"), *folder.glob("*.tmp")):
        disk.remove(draft)
    for name, path in segment_files(folder):
        if name.part and (folder / name.sealed.file_name).exists():
            disk.remove(path)


def _rebuilt(folder: Path, derived_version: str, disk: Disk) -> Manifest | None:
    try:
        manifest = rebuild(folder, derived_version)
    except NotARecording:
        return None
    store(folder, manifest, disk)
    return manifest


def _next_number(folder: Path) -> int:
    """Behind every file there is, damaged ones included."""
    stems = (path.name.split(".mcap")[0] + ".mcap" for path in folder.glob("*.mcap*"))
    numbers = [name.number for name in map(parse_file_name, stems) if name is not None]
    return max(numbers, default=-1) + 1
