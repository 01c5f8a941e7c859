"""Watches the free space: warn while there is time to act, stop before the database cannot write any more."""

import logging
from pathlib import Path

from services.archive.disk import Disk
from services.archive.parameters import GIB, ArchiveParameters
from services.bus.logs import event

log = logging.getLogger("archive")


class Space:
    """`low`: a warning is due. `stopped`: nothing may be recorded until there is clearly more space again."""

    def __init__(self, folder: Path, disk: Disk, parameters: ArchiveParameters) -> None:
        self.low = False
        self.stopped = False
        self.advice = ""
        self._folder = folder
        self._disk = disk
        self._parameters = parameters
        self.look()

    def look(self) -> None:
        """Compare the free space with the limits; each change is logged once."""
        free = self._disk.free_bytes(self._folder)
        limit = self._parameters.resume_free_bytes if self.stopped else self._parameters.stop_free_bytes
        before = (self.low, self.stopped)
        self.stopped = free < limit
        self.low = free < self._parameters.warn_free_bytes
        self.advice = f"only {free / GIB:.1f} GiB free in {self._folder}: make room, recording then goes on by itself"
        if (self.low, self.stopped) != before:
            self._tell()

    def _tell(self) -> None:
        if self.stopped:
            log.error(event("recording_stopped", reason=self.advice))
        elif self.low:
            log.warning(event("disk_low", reason=self.advice))
        else:
            log.info(event("disk_enough"))
