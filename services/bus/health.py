"""A service's report on itself, each second."""

import logging
import os
import threading
import time
from collections.abc import Callable

from schemas.health import Health, Readiness, Rejection, SessionHealth
from schemas.signals import health_key, service_token_key
from services.bus.connection import Bus
from services.bus.logs import event
from services.bus.queue import BoundedQueue

PERIOD_S = 1.0

logger = logging.getLogger(__name__)


class HealthReporter:
    """Publishes the service's Health and holds its token, once it is ready, on a thread of its own, until closed.

    `sessions`, `rejections` and `errors` are asked each second and must be quick and safe from any thread.
    """

    def __init__(
        self,
        bus: Bus,
        *,
        queue: BoundedQueue | None = None,
        sessions: Callable[[], list[SessionHealth]] = list,
        rejections: Callable[[], list[Rejection]] = list,
        errors: Callable[[], int] = int,
        readiness: Readiness = Readiness.READY,
    ) -> None:
        self._bus = bus
        self._queue = queue
        self._sessions = sessions
        self._rejections = rejections
        self._errors = errors
        self._readiness = readiness
        self._started = time.monotonic()
        self._stop = threading.Event()
        site = bus.settings.site
        self._key = health_key(site, bus.service, bus.instance)
        is_ready = readiness is Readiness.READY
        self._token = bus.declare_token(service_token_key(site, bus.service, bus.instance)) if is_ready else None
        self._thread = threading.Thread(target=self._run, name="health", daemon=True)
        self._thread.start()

    def report(self) -> Health:
        """The state of now."""
        queue = self._queue
        return Health(
            service=self._bus.service,
            instance=self._bus.instance,
            uptime_s=time.monotonic() - self._started,
            cpu_s=time.process_time(),
            rss_bytes=resident_bytes(),
            queue_length=0 if queue is None else len(queue),
            queue_capacity=0 if queue is None else queue.capacity,
            queue_dropped=0 if queue is None else queue.dropped_total,
            errors=self._bus.errors + self._errors(),
            rejections=self._rejections(),
            sessions=self._sessions(),
            readiness=self._readiness,
        )

    def close(self) -> None:
        """Take the token back and fall silent."""
        self._stop.set()
        self._thread.join(2.0)
        if self._token is not None:
            self._token.close()

    def _run(self) -> None:
        while not self._stop.wait(PERIOD_S):
            try:
                self._bus.put(self._key, self.report().model_dump_json().encode())
            except Exception:
                logger.exception(event("error", where="health"))


def resident_bytes() -> int:
    """Resident memory of this process, bytes; 0 where the system does not tell."""
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        return 0
