"""One browser's end of the live stream: a mailbox that keeps the newest skeleton, and a short queue of events."""

import asyncio
from collections import deque


class Overflow(Exception):
    """The browser took no events for so long that some would be lost; it has to read by REST again."""


class Ended(Exception):
    """Everything has been handed over and nothing more will come."""


class Viewer:
    """Lives on the event loop. Never waits for its browser, so a slow one harms nobody but itself."""

    def __init__(self, event_queue: int) -> None:
        self._event_queue = event_queue
        self._events: deque[str] = deque()
        self._newest: dict[str, str] = {}
        self._overflowed = False
        self._ended = False
        self._wake = asyncio.Event()
        self.skipped = 0

    def show(self, slot: str, text: str) -> None:
        """A value that makes the one before it in the same slot worthless."""
        self.skipped += slot in self._newest
        self._newest[slot] = text
        self._wake.set()

    def tell(self, text: str) -> None:
        """An event: each of them matters, and their order."""
        if len(self._events) >= self._event_queue:
            self._overflowed = True
        else:
            self._events.append(text)
        self._wake.set()

    def end(self) -> None:
        """Nothing more will come."""
        self._ended = True
        self._wake.set()

    async def take(self) -> str:
        """What is to be sent next; waits for it. Raises Overflow, or Ended when all has been taken."""
        while True:
            if self._overflowed:
                raise Overflow
            if self._events:
                return self._events.popleft()
            if self._newest:
                return self._newest.pop(next(iter(self._newest)))
            if self._ended:
                raise Ended
            self._wake.clear()
            await self._wake.wait()
