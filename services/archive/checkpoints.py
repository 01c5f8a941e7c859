"""Keeps the newest checkpoint of every node of every session, in memory and on disk, and hands it out on request."""

import logging
import threading
from pathlib import Path

from pydantic import BaseModel, ValidationError

from schemas.archive_layout import CHECKPOINT_PREFIX, folder_name
from schemas.checkpoint import StreamPosition
from services.archive.disk import Disk
from services.archive.parameters import ArchiveParameters
from services.bus.logs import event

log = logging.getLogger("archive")

Place = tuple[str, str]
"""Session and service."""


class _Head(BaseModel):
    """The part of a checkpoint that says what it is; the state inside is the node's own."""

    service: str
    session: str
    inputs: dict[str, StreamPosition]


class CheckpointKeeper:
    """Takes checkpoints as bytes. `take` and `newest` only touch memory; a thread writes what is new.

    A checkpoint that lies behind the kept one (from a process that was frozen and has woken up) is not taken.
    """

    def __init__(self, data_dir: Path, disk: Disk, parameters: ArchiveParameters) -> None:
        self.refused = 0
        self.failures = 0
        self._data_dir = data_dir
        self._disk = disk
        self._parameters = parameters
        self._kept: dict[Place, tuple[_Head, bytes]] = {}
        self._unwritten: dict[Place, bytes] = {}
        self._forgotten: set[str] = set()
        self._writing = False
        self._changed = threading.Condition()
        self._stopping = False
        self._thread = threading.Thread(target=self._run, name="checkpoints", daemon=True)
        self._thread.start()

    def take(self, session: str, service: str, data: bytes) -> bool:
        """Keep a checkpoint; False when it is not one, not of this place, too large or older than the kept one."""
        head = _head(data) if len(data) <= self._parameters.checkpoint_bytes else None
        known = self._find(session, service)
        if head is None or (head.session, head.service) != (session, service) or (known and _behind(head, known[0])):
            self.refused += 1
            return False
        with self._changed:
            if session in self._forgotten:
                return False
            self._keep((session, service), head, data)
            self._unwritten[session, service] = data
            self._changed.notify_all()
        return True

    def newest(self, session: str, service: str) -> bytes | None:
        """The kept checkpoint, from disk after a start; None when there is none that can be read."""
        known = self._find(session, service)
        return known[1] if known else None

    def forget(self, session: str) -> None:
        """Take and keep nothing more of a session; what is being written is waited for."""
        with self._changed:
            self._forgotten.add(session)
            self._changed.wait_for(lambda: not self._writing)
            for kept in (self._kept, self._unwritten):
                for place in [place for place in kept if place[0] == session]:
                    del kept[place]

    def wait(self, timeout_s: float = 5.0) -> bool:
        """Whether everything taken was written within the time."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._unwritten, timeout_s)

    def stop(self) -> None:
        """Write what is left and end the thread."""
        with self._changed:
            self._stopping = True
            self._changed.notify_all()
        self._thread.join()

    def _find(self, session: str, service: str) -> tuple[_Head, bytes] | None:
        place = (session, service)
        with self._changed:
            if session in self._forgotten:
                return None
            if place in self._kept:
                return self._kept[place]
            try:
                data = self._path(session, service).read_bytes()
            except (OSError, ValueError):
                return None
            head = _head(data)
            return None if head is None else self._keep(place, head, data)

    def _keep(self, place: Place, head: _Head, data: bytes) -> tuple[_Head, bytes]:
        """Into memory, for the newest few hundred nodes; of the others there is the file."""
        self._kept.pop(place, None)
        self._kept[place] = (head, data)
        for oldest in list(self._kept)[: -self._parameters.checkpoints_in_memory]:
            if oldest not in self._unwritten:
                del self._kept[oldest]
        return self._kept[place]

    def _path(self, session: str, service: str) -> Path:
        return self._data_dir / folder_name(session) / f"{CHECKPOINT_PREFIX}{folder_name(service)}.json"

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._unwritten or self._stopping)
                if not self._unwritten:
                    return
                batch, self._writing = dict(self._unwritten), True
            for place, data in batch.items():
                self._write(place, data)
            with self._changed:
                self._writing = False
                for place, data in batch.items():
                    if self._unwritten.get(place) is data:
                        del self._unwritten[place]
                self._changed.notify_all()

    def _write(self, place: Place, data: bytes) -> None:
        """A checkpoint is worth little by itself: a disk that refuses is counted, the next one comes in a second."""
        try:
            path = self._path(*place)
            path.parent.mkdir(parents=True, exist_ok=True)
            self._disk.replace_with(path, data)
        except (OSError, ValueError) as error:
            self.failures += 1
            log.warning(event("checkpoint_not_written", session=place[0], of=place[1], reason=error))


def _head(data: bytes) -> _Head | None:
    try:
        return _Head.model_validate_json(data)
    except ValidationError:
        return None


def _behind(new: _Head, kept: _Head) -> bool:
    """Whether an input of the new one lies before the kept one's."""
    return any(
        name in new.inputs and (new.inputs[name].epoch, new.inputs[name].sequence) < (place.epoch, place.sequence)
        for name, place in kept.inputs.items()
    )
