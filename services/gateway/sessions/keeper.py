"""Keeps the database and the screens in step with what the services say about sessions."""

import logging
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from sqlalchemy.exc import SQLAlchemyError

from schemas.kinematics import Calibration
from schemas.metrics import SessionMetrics
from schemas.rhythm import LearnedRhythm
from schemas.session import SessionDescription
from services.bus.logs import event
from services.gateway.access.scope import EVERYTHING
from services.gateway.database import Database
from services.gateway.live import views
from services.gateway.live.hub import LiveHub
from services.gateway.parameters import GatewayParameters
from services.gateway.sessions import records
from services.gateway.sessions.models import SessionState
from services.gateway.sessions.rhythms import record_rhythm

log = logging.getLogger(__name__)

VANISHED = "The session ended without final metrics. The recording is kept as far as it came."


@dataclass
class SessionKeeper:
    """Called from the feed's worker thread only. A database that is away never stops the live views."""

    database: Database
    live: LiveHub
    parameters: GatewayParameters = field(default_factory=GatewayParameters)
    clinic: str = "main"
    clock: Callable[[], float] = time.monotonic
    running: set[str] = field(default_factory=set)
    _erased: set[str] = field(default_factory=set)
    _finished: set[str] = field(default_factory=set)
    _reached_s: dict[str, float] = field(default_factory=dict)
    _gone_since: dict[str, float] = field(default_factory=dict)
    _unwritten: dict[tuple[str, str], Callable[[], None]] = field(default_factory=dict)

    def adopt_open_sessions(self) -> None:
        """After a start: sessions the database believes to run must show up soon, or count as gone."""
        with self.database.transaction(EVERYTHING) as database:
            for session in records.open_sessions(database):
                self._gone_since.setdefault(session, self.clock())

    def forget(self, session: str) -> None:
        """The session was erased: nothing of it is written any more, whatever still comes. From any thread."""
        self._erased.add(session)

    def appeared(self, description: SessionDescription) -> None:
        """An ingest runs this session."""
        if description.session in self._erased:
            return
        self.running.add(description.session)
        self._gone_since.pop(description.session, None)
        self.live.open(description)
        self._write((description.session, "start"), partial(self._record_start, description))

    def measured(self, session: str, metrics: SessionMetrics) -> None:
        """Metrics came; final ones are the end of the session."""
        self.live.tell(session, views.metrics_view(metrics))
        self._write((session, "metrics"), partial(self._record_metrics, session, metrics))
        if metrics.final:
            self._finished.add(session)
            self.live.close(session, SessionState.FINISHED)

    def calibrated(self, session: str, calibration: Calibration) -> None:
        """The sensors were found to sit so; also when that has changed."""
        self.live.tell(session, views.calibration_view(calibration))
        self._write((session, "calibration"), partial(self._record_calibration, session, calibration))

    def learned(self, session: str, rhythm: LearnedRhythm) -> None:
        """What the session's rhythm has learned so far; the patient's next session starts from it."""
        self._write((session, "rhythm"), partial(self._record_rhythm, session, rhythm))

    def progressed(self, session: str, captured_s: float) -> None:
        """A service has come so far with the session."""
        if session in self.running:
            self._reached_s[session] = max(captured_s, self._reached_s.get(session, 0.0))

    def gone(self, session: str) -> None:
        """The ingest let go of the session; its final metrics may still be on their way."""
        self.running.discard(session)
        self._gone_since[session] = self.clock()

    def settle(self) -> None:
        """Now and then: try again what could not be written, close what has been gone for too long."""
        waiting, self._unwritten = self._unwritten, {}
        for key, write in waiting.items():
            self._write(key, write)
        for session in list(self._finished & self._reached_s.keys()):
            length_s = self._reached_s.pop(session)
            self._write((session, "length"), partial(self._record_length, session, length_s))
        limit = self.clock() - self.parameters.final_metrics_grace_s
        for session in [name for name, since in self._gone_since.items() if since <= limit]:
            del self._gone_since[session]
            self._reached_s.pop(session, None)
            self._finished.discard(session)
            self._write((session, "end"), partial(self._record_end, session))
            self.live.close(session, SessionState.INTERRUPTED)

    def _record_start(self, description: SessionDescription) -> None:
        with self.database.transaction(EVERYTHING) as database:
            row = records.record_start(database, description, self.clinic)
            # Told before the row is let go: whoever links it to a patient meanwhile is heard after this, not before.
            self.live.assign(description.session, row.patient_code, row.clinic_id)

    def _record_metrics(self, session: str, metrics: SessionMetrics) -> None:
        with self.database.transaction(EVERYTHING) as database:
            records.record_metrics(database, session, metrics)

    def _record_calibration(self, session: str, calibration: Calibration) -> None:
        with self.database.transaction(EVERYTHING) as database:
            records.record_calibration(database, session, calibration)

    def _record_rhythm(self, session: str, rhythm: LearnedRhythm) -> None:
        with self.database.transaction(EVERYTHING) as database:
            record_rhythm(database, session, rhythm)

    def _record_length(self, session: str, length_s: float) -> None:
        with self.database.transaction(EVERYTHING) as database:
            records.record_length(database, session, length_s)

    def _record_end(self, session: str) -> None:
        with self.database.transaction(EVERYTHING) as database:
            records.record_end(database, session, SessionState.INTERRUPTED, VANISHED)

    def _write(self, key: tuple[str, str], write: Callable[[], None]) -> None:
        if key[0] in self._erased:
            return
        # By key, so that a long outage keeps one write of each kind per session and not one per stride.
        try:
            write()
        except SQLAlchemyError:
            log.exception(event("not_written", session=key[0], what=key[1]))
            self._unwritten[key] = write
