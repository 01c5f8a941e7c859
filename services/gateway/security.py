"""Response headers, and the bounds on what a client may send. Plain ASGI, so sockets and files are covered too."""

import asyncio
import contextlib
from http import HTTPStatus

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from services.gateway.headers import HEADERS, HSTS
from services.gateway.problems import problem_response


class SecurityHeaders:
    """Puts the headers on every HTTP response; API answers are never stored by a browser."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """ASGI entry."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                headers.update(HEADERS)
                if scope["scheme"] == "https":
                    headers["Strict-Transport-Security"] = HSTS
                headers["Cache-Control"] = "no-store" if scope["path"].startswith("/v1/") else "no-cache"
            await send(message)

        await self.app(scope, receive, send_with_headers)


class BodyRefused(Exception):
    """More bytes came than a request may have, or they came too slowly."""


class _Counter:
    """Counts what is received. Past the bounds nothing of the application's own answer goes out."""

    def __init__(self, receive: Receive, send: Send, most_bytes: int, within_s: float) -> None:
        self._receive = receive
        self._send = send
        self._left = most_bytes
        self._until_s = asyncio.get_running_loop().time() + within_s
        self._is_coming = True
        self.exceeded: HTTPStatus | None = None

    async def receive(self) -> Message:
        try:
            # What comes after the body is the end of the connection, whenever that may be.
            async with asyncio.timeout_at(self._until_s if self._is_coming else None):
                message = await self._receive()
        except TimeoutError:
            self.exceeded = HTTPStatus.REQUEST_TIMEOUT
            raise BodyRefused from None
        self._is_coming = bool(message.get("more_body"))
        self._left -= len(message.get("body", b""))
        if self._left < 0:
            self.exceeded = HTTPStatus.REQUEST_ENTITY_TOO_LARGE
            raise BodyRefused
        return message

    async def send(self, message: Message) -> None:
        if self.exceeded is None:
            await self._send(message)


class BodyLimit:
    """Refuses request bodies past a bound, announced or not, and those that do not come to an end."""

    def __init__(self, app: ASGIApp, most_bytes: int, within_s: float) -> None:
        self.app = app
        self.most_bytes = most_bytes
        self.within_s = within_s

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """ASGI entry."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        announced = Headers(scope=scope).get("content-length", "0")
        if not announced.isdigit() or int(announced) > self.most_bytes:
            await self._refuse(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, scope, receive, send)
            return
        counter = _Counter(receive, send, self.most_bytes, self.within_s)
        with contextlib.suppress(BodyRefused):
            await self.app(scope, counter.receive, counter.send)
        if counter.exceeded is not None:
            await self._refuse(counter.exceeded, scope, receive, send)

    async def _refuse(self, status: HTTPStatus, scope: Scope, receive: Receive, send: Send) -> None:
        response = problem_response(
            status,
            f"A request body may have {self.most_bytes} bytes and take {self.within_s:g} s.",
            "Send less in one request." if status is HTTPStatus.REQUEST_ENTITY_TOO_LARGE else "Try again.",
        )
        await response(scope, receive, send)


class HostNames:
    """Answers only to the gateway's own names, so that no foreign page can reach it by renaming (DNS rebinding)."""

    def __init__(self, app: ASGIApp, names: list[str]) -> None:
        self.app = app
        self.names = names

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """ASGI entry."""
        if scope["type"] not in ("http", "websocket") or "*" in self.names:
            await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        name = host.rpartition(":")[0] if host.rpartition(":")[2].isdigit() else host
        if name in self.names:
            await self.app(scope, receive, send)
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008, "reason": "unknown host name"})
        else:
            response = problem_response(
                HTTPStatus.MISDIRECTED_REQUEST,
                "The gateway does not answer to this host name.",
                "Open it by its own address, or add the name to AMBULA_HTTP_NAMES.",
            )
            await response(scope, receive, send)


def is_same_origin(headers: Headers) -> bool:
    """Whether a socket was opened by a page of this gateway (or by a program, which sends no Origin)."""
    origin = headers.get("origin")
    return origin is None or origin.partition("://")[2] == headers.get("host")
