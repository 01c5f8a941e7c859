"""A thread that closes files and keeps the manifests, so that neither waits for the other's disk work."""

import logging
import threading
from collections import deque
from dataclasses import dataclass, field
from pathlib import Path

from schemas.archive_layout import Manifest, RecordingState
from services.archive.disk import Disk
from services.archive.manifest import store, with_files, with_state, with_unlisted
from services.archive.parameters import ArchiveParameters
from services.archive.seal import seal
from services.bus.logs import event
from services.recordings.chunks import BROKEN
from services.recordings.errors import ArchiveError
from services.recordings.folder import read_manifest

log = logging.getLogger("archive")


@dataclass
class SealJob:
    """Files of a session to be closed, and the state the recording has then come to.

    `begin` is the manifest to start from when the folder has none that can be read.
    """

    folder: Path
    begin: Manifest
    parts: list[Path] = field(default_factory=list)
    state: RecordingState = RecordingState.RECORDING
    reason: str | None = None


class Sealer:
    """The only writer of manifests. A job that the disk refuses is tried again; its files stay as they are."""

    def __init__(self, software: str, disk: Disk, parameters: ArchiveParameters) -> None:
        self.failures = 0
        self._software = software
        self._disk = disk
        self._parameters = parameters
        self._jobs: deque[SealJob] = deque()
        self._forgotten: set[Path] = set()
        self._changed = threading.Condition()
        self._busy: SealJob | None = None
        self._stopping = False
        self._thread = threading.Thread(target=self._run, name="sealer", daemon=True)
        self._thread.start()

    def submit(self, job: SealJob) -> None:
        """Queue a job; jobs of one session are done in order."""
        with self._changed:
            self._jobs.append(job)
            self._changed.notify_all()

    def take_back(self, folder: Path) -> None:
        """Forget what is still to be done for a folder; its open files then belong to the caller again."""
        with self._changed:
            self._forgotten.add(folder)
            self._changed.wait_for(lambda: self._busy is None or self._busy.folder != folder)
            self._jobs = deque(job for job in self._jobs if job.folder != folder)
            self._forgotten.discard(folder)

    def wait(self, timeout_s: float) -> bool:
        """Whether everything submitted was done within the time."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._jobs and self._busy is None, timeout_s)

    def stop(self) -> None:
        """Finish the job in hand; what is left stays as `.part` files and is done at the next start."""
        with self._changed:
            self._stopping = True
            self._changed.notify_all()
        self._thread.join()

    @property
    def alive(self) -> bool:
        """False when the thread has met a bug; the service then ends, to be started anew."""
        return self._thread.is_alive()

    def _run(self) -> None:
        while (job := self._next()) is not None:
            self._after(job, done=self._try(job))

    def _try(self, job: SealJob) -> bool:
        try:
            do_job(job, self._software, self._disk, self._parameters.chunk_bytes)
        except OSError as error:
            self.failures += 1
            log.error(event("not_sealed", session=job.folder.name, reason=error, next="it is tried again"))
            return False
        except (ArchiveError, *BROKEN) as error:
            self.failures += 1
            log.error(event("cannot_be_sealed", session=job.folder.name, reason=error, next=".part files are kept"))
        return True

    def _next(self) -> SealJob | None:
        with self._changed:
            self._changed.wait_for(lambda: self._jobs or self._stopping)
            if self._stopping:
                return None
            self._busy = self._jobs.popleft()
            return self._busy

    def _after(self, job: SealJob, *, done: bool) -> None:
        with self._changed:
            if not done and job.folder not in self._forgotten:
                self._jobs.appendleft(job)
            self._busy = None
            self._changed.notify_all()
            if not done:
                self._changed.wait_for(lambda: self._stopping, self._parameters.retry_s)


def do_job(job: SealJob, software: str, disk: Disk, chunk_bytes: int) -> None:
    """Close the job's files one after the other and write the manifest. Can be repeated after an OSError."""
    manifest = with_unlisted(job.folder, read_manifest(job.folder) or job.begin)
    for part in [part for part in job.parts if part.exists()]:
        entry = seal(part, software, disk, chunk_bytes)
        if entry is not None:
            manifest = with_files(manifest, [entry])
            store(job.folder, manifest, disk)
    store(job.folder, with_state(manifest, job.state, job.reason), disk)
