"""The recordings of the sessions that run: begun, gone on with after a failure, closed when all has come."""

import errno
import logging
import os
import time
from functools import partial
from pathlib import Path
from typing import NamedTuple

from schemas.archive_layout import RecordingState, folder_name
from schemas.checkpoint import StreamPosition
from schemas.health import Gap, Reason
from schemas.session import SessionDescription
from schemas.signals import GAP
from services.archive.disk import Disk
from services.archive.live_session import LiveSession, Phase, expected_streams
from services.archive.manifest import new_manifest
from services.archive.parameters import ArchiveParameters
from services.archive.recorder import Closed, Recorder
from services.archive.recovery import Recovered, recover
from services.archive.sealer import Sealer, SealJob
from services.archive.space import Space
from services.archive.writer import SessionWriter, durable_of
from services.bus.logs import event
from services.bus.loop import EventLoop
from services.bus.publisher import StreamPublisher
from services.bus.receiver import Delivery
from services.flow.message import Stream
from services.flow.position import Position
from services.flow.rejections import RejectionCounter
from services.recordings.record import Record

log = logging.getLogger("archive")


class _Prepared(NamedTuple):
    """A session's folder, ready to be recorded into, or why it is not."""

    live: LiveSession
    recovered: Recovered | None
    error: OSError | None


class Recordings:
    """Lives on the event loop's thread. Whatever stops a recording, it is gone on with in the same way:

    find out what the folder holds, begin new files, and ask the producers for all that came since.
    """

    def __init__(
        self, loop: EventLoop, data_dir: Path, version: str, parameters: ArchiveParameters, disk: Disk, space: Space
    ) -> None:
        self.live: dict[str, LiveSession] = {}
        self.rejections = RejectionCounter()
        self._erased: set[str] = set()
        self.recorder = Recorder(parameters, lambda closed: loop.post(partial(self._closed, closed)))
        self.sealer = Sealer(f"ambula {version}", disk, parameters)
        self._loop = loop
        self._data_dir = data_dir
        self._version = version
        self._parameters = parameters
        self._disk = disk
        self._space = space

    @property
    def alive(self) -> bool:
        """False when one of the threads has met a bug."""
        return self.recorder.alive and self.sealer.alive

    def stop(self) -> None:
        """Bring everything to the disk; open files stay open files and are gone on with after the next start."""
        self.recorder.stop()
        self.sealer.stop()

    def appear(self, description: SessionDescription) -> None:
        """A session's token is there."""
        if description.session in self._erased:
            return
        if description.session in self.live:
            self.live[description.session].gone = False
            return
        try:
            folder = self._data_dir / folder_name(description.session)
        except ValueError as error:
            self.rejections.add(description.session, Reason.UNKNOWN_SESSION)
            log.error(event("session_refused", error=str(error)))
            return
        live = LiveSession(description, folder, expected_streams(description))
        self.live[live.session] = live
        self._open(live)

    def vanish(self, session: str) -> None:
        """A session's token has stayed away: what has come of it is all there will be."""
        live = self.live.get(session)
        if live is None:
            return
        live.gone = True
        if live.phase is Phase.RECORDING:
            self._finish(live)
        elif live.phase in (Phase.WAITING, Phase.DONE):
            self._drop(live)

    def forget(self, session: str) -> bool:
        """Whether the session's folder may be erased: nothing more is written into it. It is never recorded again."""
        live = self.live.get(session)
        if live is not None and live.phase is not Phase.DONE:
            return False
        if live is not None:
            self._drop(live)
        self._erased.add(session)
        return True

    def look(self) -> None:
        """Several times a second: close what has ended, go on with what had to wait for the disk."""
        for live in list(self.live.values()):
            live.refresh()
            if live.phase is Phase.RECORDING:
                self._look_at(live)

    def stop_all(self, reason: str) -> None:
        """Record nothing for now; each session goes on by itself when `Space` allows."""
        for live in list(self.live.values()):
            if live.phase is Phase.RECORDING:
                live.trouble = reason
                self._finish(live)

    def _open(self, live: LiveSession) -> None:
        if self.live.get(live.session) is live:
            live.phase = Phase.OPENING
            self._loop.background(partial(self._prepare, live), self._begin)

    def _prepare(self, live: LiveSession) -> _Prepared:
        """On the side thread: find out where the recording stands."""
        try:
            if self._space.stopped:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            self.sealer.take_back(live.folder)
            live.folder.mkdir(exist_ok=True)
            return _Prepared(live, recover(live.folder, live.description, self._version, self._disk), None)
        except OSError as error:
            return _Prepared(live, None, error)

    def _begin(self, prepared: _Prepared) -> None:
        live, recovered, error = prepared
        if recovered is None:
            self._wait(live, str(error))
        elif recovered.manifest.started_unix_ns != live.description.started_unix_ns:
            self._refuse(live, "another session of this id is recorded here; start this one under a new id")
        elif recovered.manifest.state is RecordingState.FINISHED and not recovered.parts:
            live.durable = durable_of(recovered.ledger)
            live.phase = Phase.DONE
        else:
            self._record(live, recovered)
        if live.gone:
            self.vanish(live.session)

    def _record(self, live: LiveSession, recovered: Recovered) -> None:
        live.writer = SessionWriter(
            live.folder,
            live.description,
            recovered.manifest.derived_version,
            ledger=recovered.ledger,
            first_number=recovered.next_number,
            parameters=self._parameters,
            disk=self._disk,
        )
        live.handed = recovered.ledger.positions()
        live.trouble = None
        live.phase = Phase.RECORDING
        self.recorder.begin(live.writer)
        self.sealer.submit(SealJob(live.folder, recovered.manifest))
        if recovered.parts:
            self.sealer.submit(SealJob(live.folder, recovered.manifest, recovered.parts))
        self._listen(live)
        log.info(event("recording", session=live.session, resumed=bool(live.handed), file=recovered.next_number))

    def _listen(self, live: LiveSession) -> None:
        live.paused = False
        live.receivers = [
            self._loop.receive(live.session, stream, _behind(live, stream), partial(self._deliver, live))
            for stream in live.streams
        ]

    def _silence(self, live: LiveSession) -> None:
        for receiver in live.receivers:
            receiver.close()

    def _deliver(self, live: LiveSession, delivery: Delivery) -> None:
        record = Record(delivery.stream, delivery.envelope, delivery.payload, time.time_ns())
        if self.recorder.put(live.session, record):
            live.handed[delivery.stream.name] = StreamPosition(
                epoch=record.envelope.epoch, sequence=record.envelope.sequence, ended=record.envelope.final
            )
        else:
            self.rejections.add("disk", Reason.QUEUE_FULL)
            live.paused = True
            self._silence(live)

    def _look_at(self, live: LiveSession) -> None:
        for receiver in live.receivers:
            for hole in receiver.take_given_up():
                gap = Gap(
                    stream=receiver.stream.name,
                    epoch=hole.epoch,
                    first_sequence=hole.first,
                    last_sequence=hole.last,
                )
                self._tell_gap(live, gap)
        if live.paused and self.recorder.waiting < self._parameters.queue_records // 2:
            self._listen(live)
        if not live.missing_ends:
            self._finish(live)

    def _tell_gap(self, live: LiveSession, gap: Gap) -> None:
        if live.gaps is None:
            live.gaps = StreamPublisher(self._loop.bus, live.session, Stream(GAP, GAP.producer))
        live.gaps.send(live.durable.captured_ns, gap)

    def _finish(self, live: LiveSession) -> None:
        self._silence(live)
        live.phase = Phase.CLOSING
        self.recorder.finish(live.session)

    def _closed(self, closed: Closed) -> None:
        """Files of a session have been closed, because they were full, or it ended, or the disk refused."""
        live = self.live.get(closed.session)
        if live is None or live.writer is None:
            return
        begin = new_manifest(live.description, self._version)
        if not closed.last:
            self.sealer.submit(SealJob(live.folder, begin, closed.parts))
            return
        live.refresh()
        live.writer = None
        self._silence(live)
        if closed.error is not None or live.trouble is not None:
            reason = live.trouble or f"the disk refused: {closed.error}"
            self.sealer.submit(SealJob(live.folder, begin, closed.parts, RecordingState.STOPPED, reason))
            self._wait(live, reason)
            return
        state, reason_text = _outcome(live)
        self.sealer.submit(SealJob(live.folder, begin, closed.parts, state, reason_text))
        log.info(event("recorded", session=live.session, state=state, captured_s=live.durable.captured_ns * 1e-9))
        live.phase = Phase.DONE
        if live.gone:
            self._drop(live)

    def _wait(self, live: LiveSession, reason: str) -> None:
        """Try again soon; the producers keep what comes meanwhile for a minute."""
        self._refuse(live, reason)
        self._loop.later(self._parameters.retry_s, partial(self._open, live))
        if live.gone:
            self._drop(live)

    def _refuse(self, live: LiveSession, reason: str) -> None:
        live.phase = Phase.WAITING
        if live.trouble != reason:
            log.error(event("not_recorded", session=live.session, reason=reason))
        live.trouble = reason

    def _drop(self, live: LiveSession) -> None:
        """The session is over. What could not be closed is closed at the next start."""
        del self.live[live.session]
        if live.gaps is not None:
            live.gaps.close()


def _behind(live: LiveSession, stream: Stream) -> Position | None:
    """Where the recording goes on; None at the beginning."""
    handed = live.handed.get(stream.name)
    return None if handed is None else Position.of(handed)


def _outcome(live: LiveSession) -> tuple[RecordingState, str | None]:
    missing = live.missing_ends
    if not missing:
        return RecordingState.FINISHED, None
    return RecordingState.INTERRUPTED, f"the session went away before these streams ended: {', '.join(missing)}"
