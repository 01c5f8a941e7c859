"""How often anybody may ask: token buckets by address, and by sign-in or key. Plain ASGI, before anything is looked up.

Live connections that are open are not counted; opening one is a request like any other.
"""

import math
import time
from collections import OrderedDict
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from http import HTTPStatus

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from services.gateway.parameters import GatewayParameters
from services.gateway.problems import problem_response

SIGNING_IN = (
    "/v1/sign-in", "/v1/first-run", "/v1/sign-in/confirmation", "/v1/me/password", "/v1/sign-in/oidc/",
)  # fmt: skip
"""Where something is guessed, or costs much: paths, and beginnings of paths that end in a slash. Reading is free."""

MOST_REMEMBERED = 8192
"""Askers whose buckets are kept; those who have not asked for longest are forgotten, about 200 bytes each."""


@dataclass(slots=True)
class _Bucket:
    tokens: float
    at_s: float


class Buckets:
    """One bucket per asker: `burst` requests at once, `per_s` of them in the long run."""

    def __init__(self, per_s: float, burst: float, clock: Callable[[], float] = time.monotonic) -> None:
        self._per_s, self._burst, self._clock = per_s, burst, clock
        self._buckets: OrderedDict[Hashable, _Bucket] = OrderedDict()

    def wait_s(self, asker: Hashable) -> float:
        """0 when the request may pass, which takes a token; else s until there is one."""
        now_s = self._clock()
        bucket = self._buckets.setdefault(asker, _Bucket(self._burst, now_s))
        self._buckets.move_to_end(asker)
        if len(self._buckets) > MOST_REMEMBERED:
            self._buckets.popitem(last=False)
        bucket.tokens = min(self._burst, bucket.tokens + (now_s - bucket.at_s) * self._per_s)
        bucket.at_s = now_s
        if bucket.tokens >= 1.0:
            bucket.tokens -= 1.0
            return 0.0
        return (1.0 - bucket.tokens) / self._per_s


class RateLimit:
    """Refuses with 429, and says when to come again."""

    def __init__(self, app: ASGIApp, parameters: GatewayParameters) -> None:
        self.app = app
        self._by_address = Buckets(parameters.requests_per_address_per_s, parameters.request_burst_of_address)
        self._by_caller = Buckets(parameters.requests_per_caller_per_s, parameters.request_burst_of_caller)
        self._signing_in = Buckets(parameters.sign_ins_per_address_per_s, parameters.sign_in_burst_of_address)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """ASGI entry."""
        wait_s = self._wait_s(scope) if scope["type"] in ("http", "websocket") else 0.0
        if wait_s <= 0.0:
            await self.app(scope, receive, send)
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1013, "reason": "too many requests"})
        else:
            response = problem_response(
                HTTPStatus.TOO_MANY_REQUESTS,
                "Too many requests came from here.",
                f"Wait {math.ceil(wait_s)} s, then try again.",
            )
            response.headers["Retry-After"] = str(math.ceil(wait_s))
            await response(scope, receive, send)

    def _wait_s(self, scope: Scope) -> float:
        address = (scope.get("client") or ("",))[0]
        waits = [self._by_address.wait_s(address)]
        caller = _claimed_caller(Headers(scope=scope))
        if caller is not None:
            waits.append(self._by_caller.wait_s(caller))
        if _is_signing_in(scope):
            waits.append(self._signing_in.wait_s(address))
        return max(waits)


def _claimed_caller(headers: Headers) -> int | None:
    """Whoever the request says it is from. A wrong claim only makes a bucket more; the address's stays the same."""
    claim = headers.get("authorization") or headers.get("cookie")
    return None if claim is None else hash(claim)


def _is_signing_in(scope: Scope) -> bool:
    path: str = scope["path"]
    if any(each.endswith("/") and path.startswith(each) for each in SIGNING_IN):
        return True
    return scope.get("method") not in ("GET", "HEAD", None) and path in SIGNING_IN
