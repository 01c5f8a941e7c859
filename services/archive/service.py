"""The archive as a service: what it listens to, what it answers, and what it says about itself."""

import logging
import threading
import time
from functools import partial
from pathlib import Path

from schemas.health import Reason, Rejection, SessionHealth
from schemas.signals import checkpoint_key, command_key, progress_key
from services.archive.catalogue import Catalogue
from services.archive.checkpoints import CheckpointKeeper
from services.archive.disk import Disk
from services.archive.erasing import Eraser, sweep
from services.archive.parameters import PARAMETERS, ArchiveParameters
from services.archive.recordings import Recordings
from services.archive.sealer import SealJob
from services.archive.space import Space
from services.archive.stale import StaleFolders
from services.bus.connection import Bus
from services.bus.health import HealthReporter
from services.bus.logs import event
from services.bus.loop import EventLoop
from services.bus.received import Received
from services.bus.sessions import SessionWatch

log = logging.getLogger("archive")


class Archive:
    """One per site. Everything runs on the event loop's thread, except what answers questions and reports health."""

    def __init__(
        self,
        bus: Bus,
        data_dir: Path,
        version: str,
        stop: threading.Event,
        parameters: ArchiveParameters = PARAMETERS,
        disk: Disk | None = None,
    ) -> None:
        disk = disk or Disk()
        data_dir.mkdir(parents=True, exist_ok=True)
        self.loop = EventLoop(bus, stop=stop)
        self._bus = bus
        self._site = bus.settings.site
        self._parameters = parameters
        sweep(data_dir, disk)
        self._space = Space(data_dir, disk, parameters)
        self._catalogue = Catalogue(data_dir)
        self._keeper = CheckpointKeeper(data_dir, disk, parameters)
        self._recordings = Recordings(self.loop, data_dir, version, parameters, disk, self._space)
        self._stale = StaleFolders(data_dir, version, disk)
        self._eraser = Eraser(self.loop, data_dir, self._recordings, self._keeper, disk)
        self._slow = False

    def run(self) -> int:
        """Work until the loop is stopped. Exit code."""
        watch = SessionWatch(
            self._bus,
            lambda description: self.loop.post(partial(self._recordings.appear, description)),
            lambda session: self.loop.post(partial(self._recordings.vanish, session)),
            grace_s=self._parameters.gone_s,
        )
        health = HealthReporter(
            self._bus,
            queue=self.loop.queue,
            sessions=self._session_health,
            rejections=lambda: watch.rejections.report() + self._rejections(),
            errors=lambda: self.loop.errors + self._recordings.sealer.failures + self._keeper.failures,
        )
        self._declare()
        self.loop.run()
        watch.close()
        health.close()
        self.loop.close()
        healthy = self._recordings.alive
        self._recordings.stop()
        self._keeper.stop()
        return 0 if healthy else 1

    def _declare(self) -> None:
        self._bus.serve(command_key(self._site, "archive", "sessions"), self._answer_sessions)
        self._bus.serve(command_key(self._site, "archive", "erase"), self._answer_erase)
        self._bus.serve(checkpoint_key(self._site, "*", "*"), self._answer_checkpoint)
        self.loop.subscribe(checkpoint_key(self._site, "*", "*"), self._take_checkpoint)
        self.loop.every(self._parameters.progress_s, self._look)
        self.loop.every(self._parameters.disk_check_s, self._look_at_disk)
        self.loop.later(self._parameters.claim_s, self._close_stale)

    def _look(self) -> None:
        if not self._recordings.alive:
            log.critical(event("thread_died", hint="the archive ends so that it is started anew"))
            self.loop.stop()
        self._recordings.look()
        now = time.monotonic()
        for live in list(self._recordings.live.values()):
            progress = live.progress_due(now, self._parameters.progress_repeat_s)
            if progress is not None and progress.positions:
                key = progress_key(self._site, live.session, "archive")
                self._bus.put(key, progress.model_dump_json().encode())

    def _look_at_disk(self) -> None:
        self._space.look()
        if self._space.stopped:
            self._recordings.stop_all(self._space.advice)
        share = self._recordings.recorder.waiting / self._parameters.queue_records
        slow = share > self._parameters.queue_alarm_share
        if slow and not self._slow:
            log.error(event("disk_slow", waiting=self._recordings.recorder.waiting))
        self._slow = slow

    def _close_stale(self) -> None:
        """Recordings of an earlier run whose session has not come back."""
        for folder in self._stale.unclaimed(set(self._recordings.live)):
            self.loop.background(partial(self._stale.job, folder), self._seal_stale)

    def _seal_stale(self, job: SealJob | None) -> None:
        if job is not None and job.folder.name not in self._recordings.live and job.folder.is_dir():
            self._recordings.sealer.submit(job)

    def _answer_sessions(self, key: str, _parameters: dict[str, str], _body: bytes) -> list[Received]:
        """On a thread of the bus."""
        return [Received(key, b"", self._catalogue.as_json())]

    def _answer_erase(self, key: str, _parameters: dict[str, str], body: bytes) -> list[Received]:
        """On a thread of the bus."""
        return [Received(key, b"", self._eraser.answer(body))]

    def _answer_checkpoint(self, key: str, _parameters: dict[str, str], _body: bytes) -> list[Received]:
        """On a thread of the bus."""
        _, session, service = key.rsplit("/", 2)
        checkpoint = self._keeper.newest(session, service)
        return [] if checkpoint is None else [Received(key, b"", checkpoint)]

    def _take_checkpoint(self, received: Received) -> None:
        _, session, service = received.key.rsplit("/", 2)
        self._keeper.take(session, service, received.payload)

    def _session_health(self) -> list[SessionHealth]:
        """On the reporter's thread."""
        return [live.health() for live in list(self._recordings.live.values())]

    def _rejections(self) -> list[Rejection]:
        """On the reporter's thread."""
        found = self._recordings.rejections.report()
        if self._keeper.refused:
            found.append(Rejection(subject="checkpoints", reason=Reason.UNDECODABLE, count=self._keeper.refused))
        if self._space.low:
            found.append(Rejection(subject="disk", reason=Reason.DISK_LOW, count=1))
        if self._slow:
            found.append(Rejection(subject="disk", reason=Reason.QUEUE_FULL, count=1))
        return found
