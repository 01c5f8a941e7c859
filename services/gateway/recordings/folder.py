"""The archive's folder of one session, read only. A file is found by listing, never by joining a name from outside."""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from schemas.archive_layout import MANIFEST_FILE, Manifest, folder_name, parse_file_name


@dataclass(frozen=True, slots=True)
class Recording:
    """One MCAP file of a session."""

    path: Path
    kind: Literal["raw", "derived"]
    complete: bool
    size_bytes: int
    sha256: str | None


def list_recordings(data_dir: Path, session: str) -> list[Recording]:
    """All MCAP files of a session, by name; empty when the archive has none. The session id must be a safe one."""
    folder = data_dir / folder_name(session)
    sums = _sums(folder)
    found = []
    for path in sorted(folder.glob("*.mcap*")) if folder.is_dir() else []:
        name = parse_file_name(path.name)
        if name is not None and path.is_file() and not path.is_symlink():
            size = path.stat().st_size
            found.append(Recording(path, name.kind, not name.part, size, sums.get(path.name)))
    return found


def _sums(folder: Path) -> dict[str, str]:
    try:
        manifest = Manifest.model_validate_json((folder / MANIFEST_FILE).read_bytes())
    except (OSError, ValueError):
        return {}
    return {entry.name: entry.sha256 for entry in manifest.files}
