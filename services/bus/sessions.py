"""Sessions as they come and go: their tokens, resolved to their descriptions."""

import logging
import queue
import threading
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass

from schemas.health import Reason
from schemas.session import SessionDescription
from schemas.signals import description_key, session_token_key
from services.bus.connection import Bus, RemoteError
from services.bus.logs import event
from services.flow.rejections import RejectionCounter

RETRY_S = 1.0
"""Between questions for a description that was not answered."""
GRACE_S = 10.0
"""A token that is gone for less was a router or a network that came back."""
TICK_S = 0.2

logger = logging.getLogger(__name__)


@dataclass
class _Watched:
    """A session whose token was seen."""

    alive: bool
    changed_at: float
    known: bool = False
    ask_at: float = 0.0


class SessionWatch:
    """Calls `on_session` once per session and `on_gone` once its token has stayed away, on a thread of its own.

    A token without a description is counted in `rejections` as unknown session, and asked for again while it lives.
    """

    def __init__(
        self,
        bus: Bus,
        on_session: Callable[[SessionDescription], None],
        on_gone: Callable[[str], None],
        grace_s: float = GRACE_S,
    ) -> None:
        self.rejections = RejectionCounter()
        self._bus = bus
        self._on_session = on_session
        self._on_gone = on_gone
        self._grace_s = grace_s
        self._watched: dict[str, _Watched] = {}
        self._changes: queue.SimpleQueue[tuple[str, bool] | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._run, name="session-watch", daemon=True)
        self._thread.start()
        self._tokens = bus.watch_tokens(
            session_token_key(bus.settings.site, "*"), lambda key, alive: self._changes.put((key, alive))
        )

    def close(self) -> None:
        """Stop watching."""
        self._tokens.close()
        self._changes.put(None)
        self._thread.join(2.0)

    def _run(self) -> None:
        while True:
            try:
                change = self._changes.get(timeout=TICK_S)
            except queue.Empty:
                self._look()
                continue
            if change is None:
                return
            self._note(change[0].rpartition("/")[2], alive=change[1])
            self._look()

    def _note(self, session: str, *, alive: bool) -> None:
        watched = self._watched.setdefault(session, _Watched(alive, 0.0))
        watched.alive = alive
        watched.changed_at = time.monotonic()

    def _look(self) -> None:
        now = time.monotonic()
        if not self._bus.connected:
            # Without a router every token looks gone; the grace starts anew when there is one again.
            for watched in self._watched.values():
                watched.changed_at = now
            return
        for session, watched in list(self._watched.items()):
            if watched.alive and not watched.known and now >= watched.ask_at:
                watched.ask_at = now + RETRY_S
                watched.known = self._resolve(session)
            elif not watched.alive and now - watched.changed_at >= self._grace_s:
                del self._watched[session]
                if watched.known:
                    self._tell(lambda session=session: self._on_gone(session))  # type: ignore[misc]

    def _resolve(self, session: str) -> bool:
        try:
            answers = self._bus.ask(description_key(self._bus.settings.site, session), timeout_s=1.0)
        except RemoteError as error:
            logger.warning(event("description_refused", session=session, error=str(error)))
            answers = []
        if not answers:
            self.rejections.add(session, Reason.UNKNOWN_SESSION)
            return False
        try:
            description = SessionDescription.model_validate_json(answers[0].payload)
        except ValueError:
            self.rejections.add(session, Reason.UNDECODABLE)
            return False
        self._tell(lambda: self._on_session(description))
        return True

    def _tell(self, call: Callable[[], None]) -> None:
        try:
            call()
        except Exception:  # noqa: BLE001 - one session must not hide the others
            self._bus.errors += 1
            logger.error(event("error", where="session_watch", trace=traceback.format_exc()))
