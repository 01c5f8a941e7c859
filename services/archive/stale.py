"""Recordings that an earlier run of the archive left open and whose sessions are no more."""

import logging
from pathlib import Path

from schemas.archive_layout import RecordingState
from services.archive.disk import Disk
from services.archive.recovery import recover
from services.archive.sealer import SealJob
from services.bus.logs import event
from services.recordings.folder import read_manifest, segment_files, session_folders

log = logging.getLogger("archive")

REASON = "the archive was stopped while it recorded, and the session was over when it came back"


class StaleFolders:
    """Those that were there at the start and are not finished."""

    def __init__(self, data_dir: Path, version: str, disk: Disk) -> None:
        self._version = version
        self._disk = disk
        self._folders = [folder for folder in session_folders(data_dir) if _is_open(folder)]

    def unclaimed(self, live: set[str]) -> list[Path]:
        """Folders of sessions that do not run any more."""
        return [folder for folder in self._folders if folder.name not in live]

    def job(self, folder: Path) -> SealJob | None:
        """What has to be done to close a folder; slow. None when nothing can be done, which is logged."""
        try:
            recovered = recover(folder, None, self._version, self._disk)
        except OSError as error:
            log.error(event("cannot_be_recovered", session=folder.name, reason=error))
            return None
        if recovered is None:
            log.warning(event("nothing_to_recover", session=folder.name))
            return None
        return SealJob(folder, recovered.manifest, recovered.parts, RecordingState.INTERRUPTED, REASON)


def _is_open(folder: Path) -> bool:
    manifest = read_manifest(folder)
    still_open = (RecordingState.RECORDING, RecordingState.STOPPED)
    return manifest is None or manifest.state in still_open or any(name.part for name, _ in segment_files(folder))
