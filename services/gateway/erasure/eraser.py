"""Erases: the list first, then rows and name, then what is on its way, then the recordings.

Whatever stops it in between, the list is what it is gone on with: at the next start, and by housekeeping.
"""

import logging
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path

from sqlalchemy.exc import OperationalError

from schemas.archive_layout import folder_name
from services.bus.logs import event
from services.gateway.access.scope import EVERYTHING
from services.gateway.control import Control, ControlRefused, ControlUnavailable
from services.gateway.database import Database
from services.gateway.directory.cipher import DirectoryUnusable
from services.gateway.directory.store import NameDirectory
from services.gateway.erasure.rows import come_back, erase_rows
from services.gateway.erasure.tombstones import Tombstone, Tombstones, digest_of
from services.gateway.exports.sending import Outgoing
from services.gateway.live.hub import LiveHub
from services.gateway.sessions.keeper import SessionKeeper

log = logging.getLogger(__name__)

HERE = "housekeeping"
"""Who erased what nobody asked for just now."""


@dataclass(frozen=True)
class Eraser:
    """One per gateway. Used from many threads; every step can be repeated."""

    database: Database
    directory: NameDirectory
    tombstones: Tombstones
    data_dir: Path
    keeper: SessionKeeper
    live: LiveHub
    control: Control
    outgoing: Outgoing = field(default_factory=Outgoing)

    def erase(self, patient: str | None, sessions: Sequence[str], by: str, reason: str, now: datetime) -> int:
        """Erase a patient with their sessions, or sessions alone; number of recordings that are still to be removed.

        Raises OSError when the list can not be written, OperationalError when a database does not answer; nothing is
        erased by halves then: it is gone on with later.
        """
        place = None if patient is None else self._place_of(patient)
        digest = None if patient is None else digest_of(patient)
        stone = Tombstone(
            patient_sha256=digest, name_place=place, sessions=list(sessions), at=now, by=by, reason=reason
        )
        self.tombstones.add(stone)
        with self.database.transaction(EVERYTHING) as database:
            erase_rows(database, [] if patient is None else [patient], sessions)
        self._forget(sessions, [] if place is None else [place])
        log.info(event("erased", sessions=len(sessions), reason=reason))
        return len(self.remove_recordings(sessions))

    def apply_again(self) -> int:
        """At a start: erase what is there although it was erased; number of patients and sessions that were."""
        stones = self.tombstones.read()
        if not stones:
            return 0
        with self.database.transaction(EVERYTHING) as database:
            codes, sessions = come_back(database, stones)
            erase_rows(database, codes, sessions)
        more = [session for session in sessions if not any(session in stone.sessions for stone in stones)]
        if more:
            # Sessions that an older backup knew of the patient, and this list does not: their recordings go too.
            at = max(stone.at for stone in stones)
            self.tombstones.add(
                Tombstone(patient_sha256=None, name_place=None, sessions=more, at=at, by=HERE, reason="applied_again")
            )
        removed = self._remove_names([stone.name_place for stone in stones if stone.name_place is not None])
        if codes or sessions or removed:
            log.warning(event("erased_again", patients=len(codes), sessions=len(sessions)))
            self._scrub()
        return len(codes) + len(sessions)

    def finish(self) -> int:
        """Have the archive remove recordings that were left; how many still are."""
        named = [session for stone in self.tombstones.read() for session in stone.sessions]
        left = [session for session in dict.fromkeys(named) if self._is_recorded(session)]
        return len(self.remove_recordings(left))

    def remove_recordings(self, sessions: Sequence[str]) -> list[str]:
        """Order the archive to remove recordings; those that are still there."""
        recorded = list(sessions)
        try:
            gone = set(self.control.erase(recorded)) if recorded else set()
        except (ControlUnavailable, ControlRefused) as error:
            log.warning(event("recordings_left", sessions=len(recorded), reason=error))
            gone = set()
        return [session for session in recorded if session not in gone or self._is_recorded(session)]

    def _forget(self, sessions: Sequence[str], places: Sequence[str]) -> None:
        for session in sessions:
            self.keeper.forget(session)
            self.live.forget(session)
        self.outgoing.stop(sessions)
        self._remove_names(places)
        self._scrub()

    def _is_recorded(self, session: str) -> bool:
        try:
            return (self.data_dir / folder_name(session)).exists()
        except ValueError:
            return False

    def _place_of(self, patient: str) -> str | None:
        try:
            return self.directory.place_of(patient)
        except DirectoryUnusable:
            return None

    def _remove_names(self, places: Sequence[str]) -> int:
        return self.directory.remove(places) if places else 0

    def _scrub(self) -> None:
        # Rows are gone and zeroed already; this is for what SQLite may have left when it moved them.
        for each in (self.database, self.directory):
            try:
                each.scrub()
            except OperationalError:
                log.warning(event("not_scrubbed", hint="others write just now; it is done with the next erasure"))
