"""Many browsers' ends of the live stream, without browsers: one thread, one loop, one of them never reads."""

import asyncio
import contextlib
import json
import socket
import time
from dataclasses import dataclass, field

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from services.bench.web.site import Origins, Site

OPEN_S = 30.0


@dataclass
class Seen:
    """What all clients together received."""

    latency_s: list[float] = field(default_factory=list)
    """From the capture of the newest sample behind a skeleton to its receipt."""
    gap_s: list[float] = field(default_factory=list)
    """Between two skeletons at one client."""
    closed: int = 0
    """Clients that were let go before the end."""


def watch(site: Site, clients: int, seconds: float, *, stalled: bool) -> Seen:
    """Let clients watch the sessions in turn; with `stalled`, one more opens the first session and never reads."""
    return asyncio.run(_watch(site, clients, seconds, stalled=stalled))


async def _watch(site: Site, clients: int, seconds: float, *, stalled: bool) -> Seen:
    seen = Seen()
    until_s = time.monotonic() + seconds
    async with contextlib.AsyncExitStack() as stack:
        if stalled:
            await stack.enter_async_context(_never_reading(site))
        sessions = [site.sessions[number % len(site.sessions)] for number in range(clients)]
        await asyncio.gather(*(_client(site, session, until_s, seen) for session in sessions))
    return seen


async def _client(site: Site, session: str, until_s: float, seen: Seen) -> None:
    try:
        async with asyncio.timeout(until_s - time.monotonic()), _connected(site, session) as live:
            await _read(live, site.origins, session, seen)
    except TimeoutError:
        return
    except ConnectionClosed:
        pass
    seen.closed += 1


async def _read(live: ClientConnection, origins: Origins, session: str, seen: Seen) -> None:
    before_s = None
    async for text in live:
        now_s = time.monotonic()
        message = json.loads(text)
        if message["kind"] != "pose":
            continue
        if message["phase"] == "estimating":
            seen.latency_s.append(now_s - origins.s[session] - message["at_s"])
        if before_s is not None:
            seen.gap_s.append(now_s - before_s)
        before_s = now_s


def _connected(site: Site, session: str, sock: socket.socket | None = None) -> connect:
    name, value = site.door.cookie
    address = f"{site.door.url.replace('http', 'ws', 1)}/v1/live/{session}"
    headers = {"Cookie": f"{name}={value}"}
    return connect(address, additional_headers=headers, sock=sock, compression=None, open_timeout=OPEN_S, max_size=None)


@contextlib.asynccontextmanager
async def _never_reading(site: Site):  # type: ignore[no-untyped-def]
    """The smallest buffer there is, filled and left alone."""
    host, _, port = site.door.url.removeprefix("http://").partition(":")
    raw = socket.socket()
    raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1)
    raw.connect((host, int(port)))
    raw.setblocking(False)
    live = await _connected(site, site.sessions[0], raw)
    live.transport.pause_reading()
    try:
        yield live
    finally:
        live.transport.abort()
