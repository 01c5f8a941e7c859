"""The list of recorded sessions, from the manifests on disk."""

import json
from pathlib import Path

from schemas.archive_layout import MANIFEST_FILE, Manifest
from services.recordings.folder import read_manifest, session_folders


class Catalogue:
    """Reads a manifest again only when it has changed."""

    def __init__(self, data_dir: Path) -> None:
        self._data_dir = data_dir
        self._known: dict[Path, tuple[tuple[int, int], Manifest]] = {}

    def sessions(self) -> list[Manifest]:
        """Every session that has a readable manifest, newest first."""
        found = (self._read(folder) for folder in session_folders(self._data_dir))
        return sorted((item for item in found if item is not None), key=lambda item: -item.started_unix_ns)

    def as_json(self) -> bytes:
        """The list as a JSON array of manifests, each with the `folder` below the data directory."""
        return json.dumps(
            [{**item.model_dump(mode="json"), "folder": item.session} for item in self.sessions()]
        ).encode()

    def _read(self, folder: Path) -> Manifest | None:
        try:
            facts = (folder / MANIFEST_FILE).stat()
        except FileNotFoundError:
            return None
        stamp = (facts.st_mtime_ns, facts.st_ino)
        if folder not in self._known or self._known[folder][0] != stamp:
            manifest = read_manifest(folder)
            if manifest is None:
                return None
            self._known[folder] = (stamp, manifest)
        return self._known[folder][1]
