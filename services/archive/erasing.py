"""Removing a session's folder for good, because a person asked for it or its time is over."""

import json
import logging
import os
import threading
from collections.abc import Callable
from functools import partial
from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from schemas.archive_layout import folder_name
from services.archive.checkpoints import CheckpointKeeper
from services.archive.disk import Disk
from services.archive.recordings import Recordings
from services.bus.logs import event
from services.bus.loop import EventLoop

log = logging.getLogger("archive")

DOOMED_PREFIX = ".erased-"
"""A folder gets this name first, so that nobody finds half of a recording; what a kill leaves is swept at the start."""
LOOP_PATIENCE_S = 5.0


class EraseOrder(BaseModel):
    """A command's body."""

    model_config = ConfigDict(frozen=True, extra="ignore")

    sessions: list[str] = Field(max_length=10_000)


class Eraser:
    """Answers the command `erase`, on a thread of the bus. A session that is still recorded is left alone."""

    def __init__(
        self, loop: EventLoop, data_dir: Path, recordings: Recordings, keeper: CheckpointKeeper, disk: Disk
    ) -> None:
        self._loop = loop
        self._data_dir = data_dir
        self._recordings = recordings
        self._keeper = keeper
        self._disk = disk

    def answer(self, body: bytes) -> bytes:
        """{"erased": [...]}: sessions of which nothing is left; or {"error": reason}."""
        try:
            order = EraseOrder.model_validate_json(body)
        except ValidationError as error:
            return json.dumps({"error": f"not an order to erase: {error.error_count()} faults"}).encode()
        return json.dumps({"erased": [session for session in order.sessions if self._erase(session)]}).encode()

    def _erase(self, session: str) -> bool:
        try:
            folder = self._data_dir / folder_name(session)
        except ValueError:
            return False
        if not self._on_loop(partial(self._recordings.forget, session)):
            log.warning(event("not_erased", session=session, hint="it is still recorded; stop it first"))
            return False
        try:
            self._recordings.sealer.take_back(folder)
            self._keeper.forget(session)
            erase_folder(folder, self._disk)
        except OSError as error:
            log.error(event("not_erased", session=session, reason=error))
            return False
        log.info(event("erased", session=session))
        return True

    def _on_loop(self, question: Callable[[], bool]) -> bool:
        """Ask on the loop's thread, which alone knows what is being recorded; False when it does not get to it."""
        answers: list[bool] = []
        answered = threading.Event()

        def ask() -> None:
            answers.append(question())
            answered.set()

        self._loop.post(ask)
        return answered.wait(LOOP_PATIENCE_S) and answers[0]


def erase_folder(folder: Path, disk: Disk) -> None:
    """Remove a session's folder and everything in it; it is no error when there is none. Raises OSError."""
    doomed = folder.with_name(DOOMED_PREFIX + folder.name)
    if folder.is_symlink():
        disk.remove(folder)
    elif folder.is_dir():
        _remove_tree(doomed, disk)
        disk.replace(folder, doomed)
        disk.sync_folder(folder.parent)
    _remove_tree(doomed, disk)


def sweep(data_dir: Path, disk: Disk) -> None:
    """Finish what a kill interrupted. Raises OSError."""
    for doomed in data_dir.glob(f"{DOOMED_PREFIX}*"):
        _remove_tree(doomed, disk)


def _remove_tree(folder: Path, disk: Disk) -> None:
    if not folder.is_dir():
        return
    for inside in folder.iterdir():
        if inside.is_dir() and not inside.is_symlink():
            _remove_tree(inside, disk)
        else:
            disk.remove(inside)
    os.rmdir(folder)
    disk.sync_folder(folder.parent)
