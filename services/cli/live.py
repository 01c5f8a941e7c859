"""Commands that talk to running services: start a session, watch it to its end."""

import json
import queue
from collections.abc import Iterator
from typing import Any

from schemas.health import Progress
from schemas.metrics import SessionMetrics
from schemas.session import SessionDescription
from schemas.signals import METRICS, command_key, progress_key, stream_key
from services.bus.connection import Bus
from services.bus.received import Received

SILENCE_S = 60.0
"""s. A service that crashed is back well before; a session without any news for so long is not coming to its end."""


class NotStarted(RuntimeError):
    """Ingest refused a session, or no ingest answers."""


class WentSilent(RuntimeError):
    """A session makes no more progress."""


def start_session(bus: Bus, spec: str, speed: float | None, estimator: str | None) -> SessionDescription:
    """Ask an ingest to play a source as a live session. `speed` None: as fast as the services follow.

    Raises NotStarted with the reason that ingest gave, or with what to do when no ingest answers.
    """
    order = {"source": spec, "speed": speed, "estimator": estimator, "session": None}
    replies = bus.ask(command_key(bus.settings.site, "ingest", "start"), body=json.dumps(order).encode(), timeout_s=30)
    if not replies:
        raise NotStarted("no ingest answers; start the services with `ambula up` first")
    answer: dict[str, Any] = json.loads(replies[0].payload)
    if "error" in answer:
        raise NotStarted(answer["error"])
    return SessionDescription.model_validate(answer)


def follow(bus: Bus, description: SessionDescription) -> Iterator[float | SessionMetrics]:
    """Seconds of the session done so far, again and again, and last its final metrics.

    Raises WentSilent when no service says anything about the session for a minute.
    """
    arrived: queue.SimpleQueue[Received] = queue.SimpleQueue()
    site, session = bus.settings.site, description.session
    handles = [
        bus.subscribe(stream_key(site, session, METRICS, "*"), arrived.put),
        bus.subscribe(progress_key(site, session, "metrics"), arrived.put),
        bus.subscribe(progress_key(site, session, "estimation"), arrived.put),
    ]
    try:
        while True:
            try:
                received = arrived.get(timeout=SILENCE_S)
            except queue.Empty:
                raise WentSilent(f"no news of session {session} for {SILENCE_S:.0f} s; see `ambula doctor`") from None
            if f"/{METRICS.name}/" in received.key and received.payload:
                metrics = SessionMetrics.model_validate_json(received.payload)
                if metrics.final:
                    yield metrics
                    return
            elif "@progress" in received.key:
                yield Progress.model_validate_json(received.payload).captured_ns * 1e-9
    finally:
        for handle in handles:
            handle.close()
