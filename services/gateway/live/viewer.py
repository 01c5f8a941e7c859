"""One browser's end of the live stream: a mailbox that keeps the newest skeleton, and a short queue of events."""

import asyncio
from collections import deque

from services.gateway.access.scope import Scope

NORMAL, GOING_AWAY, POLICY, TRY_AGAIN, SIGN_IN = 1000, 1001, 1008, 1013, 4401
"""Close codes: the session is over; the gateway stops; not yours; too slow, so read by REST and come again; the sign-in
has ended."""


class Ended(Exception):
    """Nothing more will come; `code` and `reason` are for the closing handshake."""

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(reason)
        self.code = code
        self.reason = reason


class Viewer:
    """Lives on the event loop. Never waits for its browser, so a slow one harms nobody but itself."""

    def __init__(self, event_queue: int, scope: Scope) -> None:
        self.scope = scope
        self._event_queue = event_queue
        self._events: deque[str] = deque()
        self._newest: dict[str, str] = {}
        self._ended: Ended | None = None
        self._wake = asyncio.Event()
        self.skipped = 0

    def show(self, slot: str, text: str) -> None:
        """A value that makes the one before it in the same slot worthless."""
        self.skipped += slot in self._newest
        self._newest[slot] = text
        self._wake.set()

    def tell(self, text: str) -> None:
        """An event: each of them matters, and their order."""
        if len(self._events) < self._event_queue:
            self._events.append(text)
            self._wake.set()
        else:
            self._events.clear()
            self.end(TRY_AGAIN, "too slow: read the session again")

    def end(self, code: int, reason: str) -> None:
        """Nothing more will come. The first reason counts."""
        self._ended = self._ended or Ended(code, reason)
        self._wake.set()

    async def take(self) -> str:
        """What is to be sent next; waits for it. Raises Ended when all has been taken."""
        while True:
            if self._events:
                return self._events.popleft()
            if self._newest:
                return self._newest.pop(next(iter(self._newest)))
            if self._ended is not None:
                raise self._ended
            self._wake.clear()
            await self._wake.wait()
