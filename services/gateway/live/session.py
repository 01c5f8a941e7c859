"""One running session, as the hub keeps it."""

import asyncio
import contextlib
from collections import deque
from dataclasses import dataclass, field

from schemas.quality import DataQuality
from schemas.session import SessionDescription
from services.gateway.live.memory import Memory
from services.gateway.live.viewer import Viewer

PERIODS = 2
"""Between words on the quality of the data, 5 s each: what is told of a sensor is of the last ten seconds."""


@dataclass(slots=True, eq=False)
class ArrivedPose:
    """A skeleton as it came, and when."""

    payload: bytes
    received_s: float


@dataclass(eq=False)
class LiveSession:
    """What is known of it and who watches it. Until its clinic is known nobody but the site itself sees it.

    `poses` is appended to by the bus's thread; everything else lives on the event loop. `task` shows skeletons while
    somebody watches, `arrival` wakes it.
    """

    description: SessionDescription
    poses: deque[ArrivedPose]
    patient: str | None = None
    clinic: str | None = None
    memory: Memory = field(default_factory=Memory)
    viewers: set[Viewer] = field(default_factory=set)
    qualities: deque[DataQuality] = field(default_factory=lambda: deque(maxlen=PERIODS))
    task: asyncio.Task[None] | None = None
    arrival: asyncio.Event = field(default_factory=asyncio.Event)

    def age_s(self, now_s: float) -> float | None:
        """s since the newest skeleton came; None before the first."""
        return round(now_s - self.poses[-1].received_s, 2) if self.poses else None

    async def until_arrival(self, most_s: float) -> None:
        """Wait for the next skeleton, but no longer than that."""
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(most_s):
                await self.arrival.wait()
        self.arrival.clear()
