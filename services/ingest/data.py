"""Where data lies: recordings are named relative to a few well-known folders, never by a machine's path."""

import os
from pathlib import Path

from services.ingest.errors import MissingFile

MANIFESTS = Path(__file__).parent / "manifests"
"""Manifests that come with the software; their data does not."""

_REPOSITORY = Path(__file__).parents[2]


def data_folders() -> list[Path]:
    """Folders searched for recordings: AMBULA_DATA, then `../shared/data` beside the work folder or the repository."""
    named = os.environ.get("AMBULA_DATA")
    beside = [Path("../shared/data").resolve(), (_REPOSITORY / "../shared/data").resolve()]
    return ([Path(named)] if named else []) + list(dict.fromkeys(beside))


def find_data_root() -> Path | None:
    """The first of those folders that exists."""
    return next((folder for folder in data_folders() if folder.is_dir()), None)


def find_data(name: str, beside: Path | None = None) -> Path:
    """The folder of a recording: relative to `beside` (the manifest's folder) or to one of `data_folders`.

    Raises MissingFile, listing where it was looked for.
    """
    candidates = ([beside / name] if beside else []) + [folder / name for folder in data_folders()]
    for candidate in candidates:
        if candidate.is_dir():
            return candidate
    searched = ", ".join(str(candidate) for candidate in candidates)
    raise MissingFile(f"no folder {name!r} (looked at {searched}); set AMBULA_DATA to the folder that holds it")
