"""Commands that talk to running services: start a session, watch it to its end."""

import json
import queue
import secrets
import time
from collections import deque
from collections.abc import Iterator
from typing import Any, Self

from schemas.health import Progress
from schemas.metrics import SessionMetrics
from schemas.session import SessionDescription
from schemas.signals import METRICS, command_key, progress_key, replay_key, stream_key
from services.bus.connection import Bus
from services.bus.received import Received
from services.cli.interrupt import on_interrupt
from services.ingest.choices import AS_THE_SOURCE_SAYS, Choices

SILENCE_S = 60.0
"""s. A service that crashed is back well before; a session without any news for so long is not coming to its end."""

START_TIMEOUT_S = 15.0
"""Opening a long recording takes seconds."""
START_TRIES = 3


class NotStarted(RuntimeError):
    """Ingest refused an order, or no ingest answers."""


class WentSilent(RuntimeError):
    """A session makes no more progress."""


def start_session(
    bus: Bus, spec: str, speed: float | None, choices: Choices = AS_THE_SOURCE_SAYS, session: str | None = None
) -> SessionDescription:
    """Ask an ingest to play a source as a live session. `speed` None: as fast as the services follow.

    The session has an id from the beginning, so that an order whose answer got lost can be given again. Raises
    NotStarted with the reason that ingest gave, or with what to do when no ingest answers.
    """
    known = choices.known_rhythms
    order = {
        "source": spec,
        "speed": speed,
        "estimator": choices.estimator,
        "walk_path": choices.walk_path,
        "known_rhythms": None if known is None else [each.model_dump(mode="json") for each in known],
        "task": choices.task,
        "walkway_m": choices.walkway_m,
        "conditions": None if choices.conditions is None else choices.conditions.model_dump(mode="json"),
        "session": session or secrets.token_hex(8),
    }
    key, body = command_key(bus.settings.site, "ingest", "start"), json.dumps(order).encode()
    replies = bus.ask_again(key, body, START_TIMEOUT_S, START_TRIES)
    if not replies:
        raise NotStarted("no ingest answers; start the services with `ambula up` first")
    answer: dict[str, Any] = json.loads(replies[0].payload)
    if "error" in answer:
        raise NotStarted(answer["error"])
    return SessionDescription.model_validate(answer)


def mark_standing(bus: Bus, session: str, last_s: float) -> tuple[float, float]:
    """Mark the last seconds of a running session as standing; the span in s of session time.

    Raises NotStarted with the reason that ingest gave, or with what to do when no ingest answers.
    """
    order = {"session": session, "last_s": last_s}
    replies = bus.ask(command_key(bus.settings.site, "ingest", "mark"), body=json.dumps(order).encode(), timeout_s=5)
    if not replies:
        raise NotStarted("no ingest answers; start the services with `ambula up` first")
    answer: dict[str, Any] = json.loads(replies[0].payload)
    if "error" in answer:
        raise NotStarted(answer["error"])
    return float(answer["from_s"]), float(answer["to_s"])


def stop_session(bus: Bus, session: str) -> None:
    """End a session's streams. Nothing happens when no ingest runs it."""
    order = {"session": session}
    bus.ask(command_key(bus.settings.site, "ingest", "stop"), body=json.dumps(order).encode(), timeout_s=5)


class Watch:
    """News of all sessions of the site from now on. Make it before a session starts: a short one is soon over."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._arrived: queue.SimpleQueue[Received] = queue.SimpleQueue()
        self._kept: dict[str, deque[Received]] = {}
        site = bus.settings.site
        keys = [stream_key(site, "*", METRICS, "*")]
        keys += [progress_key(site, "*", service) for service in ("estimation", METRICS.producer)]
        self._handles = [bus.subscribe(key, self._arrived.put) for key in keys]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        for handle in self._handles:
            handle.close()

    def follow(self, description: SessionDescription) -> Iterator[float | SessionMetrics]:
        """Seconds of the session done so far, again and again, and last its final metrics.

        Raises WentSilent when no service says anything about the session for a minute.
        """
        while True:
            received = self._next(description.session)
            if "@progress" not in received.key:
                metrics = SessionMetrics.model_validate_json(received.payload) if received.payload else None
            else:
                progress = Progress.model_validate_json(received.payload)
                yield progress.captured_ns * 1e-9
                is_over = progress.ended and progress.service == METRICS.producer
                metrics = self._ask_final(description.session) if is_over else None
            if metrics is not None and metrics.final:
                yield metrics
                return

    def _next(self, session: str) -> Received:
        """The session's next news; what comes of other sessions meanwhile is kept for them."""
        until = time.monotonic() + SILENCE_S
        while not self._kept.get(session):
            try:
                received = self._arrived.get(timeout=max(0.0, until - time.monotonic()))
            except queue.Empty:
                raise WentSilent(f"no news of session {session} for {SILENCE_S:.0f} s; see `ambula doctor`") from None
            words = received.key.split("/")
            of = words[3] if words[2] == "@progress" else words[2]
            self._kept.setdefault(of, deque()).append(received)
        return self._kept[session].popleft()

    def _ask_final(self, session: str) -> SessionMetrics | None:
        """The final metrics from the producer's ring: live messages are never waited for, so one may be lost."""
        key = replay_key(self._bus.settings.site, session, METRICS, METRICS.producer)
        answers = [each.payload for each in self._bus.ask(key, {"from": "0", "most": "100000"}) if each.attachment]
        said = [SessionMetrics.model_validate_json(payload) for payload in answers if payload]
        return said[-1] if said else None


def followed(bus: Bus, watch: Watch, description: SessionDescription) -> Iterator[float | SessionMetrics]:
    """`watch.follow`. Ctrl-C ends a device's session, whose metrics then come; any other source plays on without us."""
    is_device = description.origin == "device"
    with on_interrupt((lambda: stop_session(bus, description.session)) if is_device else None):
        yield from watch.follow(description)
