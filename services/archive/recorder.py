"""A thread that writes all sessions: every 100 ms to the operating system, and as fast as it can to the disk.

The two are apart because a kill must cost 0.1 s at most also where a sync takes longer than that.
"""

import logging
import queue
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from services.archive.parameters import ArchiveParameters
from services.archive.writer import PendingSync, SessionWriter
from services.bus.logs import event
from services.recordings.record import Record

log = logging.getLogger("archive")

SYNC_THREADS = 4
"""Syncs that wait at once; a file system can bring them to the disk together."""


@dataclass(frozen=True)
class Closed:
    """A session's files have been closed; `error` is why, None when it was asked for or when they were full."""

    session: str
    parts: list[Path]
    error: OSError | None
    last: bool


@dataclass
class _Order:
    """What the thread is asked to do: take a writer, a record, or close a session."""

    session: str
    writer: SessionWriter | None = None
    record: Record | None = None


class Recorder:
    """Takes messages from one thread and writes them in another. `on_closed` is called in the writing thread."""

    def __init__(self, parameters: ArchiveParameters, on_closed: Callable[[Closed], None]) -> None:
        self.dropped = 0
        self._parameters = parameters
        self._on_closed = on_closed
        self._orders: queue.Queue[_Order] = queue.Queue(parameters.queue_records)
        self._writers: dict[str, SessionWriter] = {}
        self._stop = threading.Event()
        self._pool = ThreadPoolExecutor(SYNC_THREADS, thread_name_prefix="sync")
        self._syncs: dict[str, tuple[PendingSync, Future[None]]] = {}
        self._thread = threading.Thread(target=self._run, name="recorder", daemon=True)
        self._thread.start()

    @property
    def waiting(self) -> int:
        """Number of messages that have not been taken yet."""
        return self._orders.qsize()

    def begin(self, writer: SessionWriter) -> None:
        """Take over a writer; from now on only the recorder touches it, except for `durable` and `counts`."""
        self._orders.put(_Order(writer.description.session, writer=writer))

    def put(self, session: str, record: Record) -> bool:
        """Hand over a message; False at once when the disk is so slow that no more may wait."""
        try:
            self._orders.put_nowait(_Order(session, record=record))
        except queue.Full:
            return False
        return True

    def finish(self, session: str) -> None:
        """Close a session's files behind the messages put before."""
        self._orders.put(_Order(session))

    def stop(self) -> None:
        """Write what was put, close all files and end the thread."""
        self._stop.set()
        self._thread.join()
        self._pool.shutdown()

    @property
    def alive(self) -> bool:
        """False when the thread has met a bug; the service then ends, to be started anew."""
        return self._thread.is_alive()

    def _run(self) -> None:
        while not self._stop.is_set():
            self._take_until(time.monotonic() + self._parameters.flush_interval_s)
            self._round()
        while not self._orders.empty():
            self._carry_out(self._orders.get())
        for session in list(self._writers):
            self._close(session, last=True)

    def _take_until(self, deadline_s: float) -> None:
        while (left_s := deadline_s - time.monotonic()) > 0:
            try:
                self._carry_out(self._orders.get(timeout=left_s))
            except queue.Empty:
                return

    def _carry_out(self, order: _Order) -> None:
        if order.writer is not None:
            self._writers[order.session] = order.writer
        elif order.record is None:
            self._close(order.session, last=True)
        elif order.session in self._writers:
            self._guarded(order.session, partial(SessionWriter.write, record=order.record))
        else:
            self.dropped += 1

    def _round(self) -> None:
        """Push everything; settle the syncs that are through, and start those that are due."""
        for session in list(self._writers):
            self._guarded(session, SessionWriter.push)
            if session in self._syncs and not self._settled(session):
                continue
            writer = self._writers.get(session)
            if writer is not None and writer.full:
                self._close(session, last=False)
            elif writer is not None:
                self._sync(session, writer)

    def _sync(self, session: str, writer: SessionWriter) -> None:
        pending = writer.pending()
        if pending.journals:
            self._syncs[session] = (pending, self._pool.submit(pending.run))
        else:
            writer.settle(pending)

    def _settled(self, session: str, *, wait: bool = False) -> bool:
        pending, future = self._syncs[session]
        if not wait and not future.done():
            return False
        del self._syncs[session]
        error = future.exception()
        if error is None:
            self._writers[session].settle(pending)
        elif isinstance(error, OSError):
            self._fail(session, error)
        else:
            raise error
        return True

    def _close(self, session: str, *, last: bool) -> None:
        if session in self._syncs:
            self._settled(session, wait=True)
        self._guarded(session, SessionWriter.flush)
        writer = self._writers.get(session)
        if writer is None:
            return
        if last:
            del self._writers[session]
        self._on_closed(Closed(session, writer.close(), None, last))

    def _guarded(self, session: str, action: Callable[[SessionWriter], None]) -> None:
        writer = self._writers.get(session)
        if writer is None:
            return
        try:
            action(writer)
        except OSError as error:
            self._fail(session, error)

    def _fail(self, session: str, error: OSError) -> None:
        """The disk refused: the session's files are closed as they are, and the others go on."""
        log.error(event("recording_stopped", session=session, reason=error))
        if session in self._syncs:
            self._syncs.pop(session)[1].exception()
        writer = self._writers.pop(session)
        self._on_closed(Closed(session, writer.close(), error, last=True))
