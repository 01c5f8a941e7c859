"""Counts and times requests by their route's template, never by their path. Plain ASGI."""

import time

from fastapi.routing import APIRoute
from prometheus_client import CollectorRegistry, Counter, Histogram
from starlette.types import ASGIApp, Message, Receive, Scope, Send

OTHER = "other"
"""Pages, assets, and what no route answers."""
SIGNING_IN = frozenset(
    {
        ("POST", "/v1/sign-in"),
        ("POST", "/v1/sign-in/confirmation"),
        ("POST", "/v1/first-run"),
        ("GET", "/v1/sign-in/oidc/{provider}/callback"),
    }
)
REFUSED = (401, 403, 429)
METHODS = frozenset({"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"})
BUCKETS_S = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 10.0)


class RequestNumbers:
    """What is counted of requests."""

    def __init__(self, registry: CollectorRegistry) -> None:
        labels = ("method", "route")
        self.requests = Counter(
            "ambula_requests", "Requests answered, by status.", (*labels, "status"), registry=registry
        )
        self.seconds = Histogram(
            "ambula_request_duration_seconds", "Time until the answer began.", labels, buckets=BUCKETS_S,
            registry=registry,
        )  # fmt: skip
        self.log_in_failures = Counter(
            "ambula_log_in_failures", "Wrong passwords, codes and refused sign-ins.", registry=registry
        )

    def note(self, method: str, route: str, status: int, took_s: float) -> None:
        """One answer has begun."""
        known = method if method in METHODS else OTHER
        self.requests.labels(known, route, str(status)).inc()
        self.seconds.labels(known, route).observe(took_s)
        if (method, route) in SIGNING_IN and status in REFUSED:
            self.log_in_failures.inc()


class CountRequests:
    """Around the application."""

    def __init__(self, app: ASGIApp, numbers: RequestNumbers) -> None:
        self.app = app
        self._numbers = numbers

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """ASGI entry."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        began = time.perf_counter()

        async def send_and_count(message: Message) -> None:
            if message["type"] == "http.response.start":
                took_s = time.perf_counter() - began
                self._numbers.note(scope["method"], template_of(scope), message["status"], took_s)
            await send(message)

        await self.app(scope, receive, send_and_count)


def template_of(scope: Scope) -> str:
    """The route's path with its parameters' names instead of their values; `other` where it is no route of the API."""
    route = scope.get("route")
    return route.path_format if isinstance(route, APIRoute) and route.include_in_schema else OTHER
