"""The main loop of a service that hosts one node per session."""

import logging
import threading
import time
from collections.abc import Callable, Sequence
from typing import TypeVar

from schemas.health import Progress, Reason, Rejection, SessionHealth
from schemas.session import SessionDescription
from schemas.signals import progress_key
from services.bus.connection import Bus
from services.bus.health import HealthReporter
from services.bus.hosting import NodeSession, open_host
from services.bus.lifetime import stop_event
from services.bus.logs import event, set_up_logging
from services.bus.loop import EventLoop
from services.bus.preparation import prepare
from services.bus.received import Received
from services.bus.sessions import SessionWatch
from services.bus.settings import BusSettings
from services.flow.host import HostedNode
from services.flow.node import NodeFactory
from services.flow.rejections import RejectionCounter

TICK_S = 0.1
FAREWELL_S = 0.8
"""At most, for the readers to catch up with the last checkpoints when the service is told to stop."""

Argument = TypeVar("Argument")

logger = logging.getLogger(__name__)


def run_node_service(service: str, build: NodeFactory, warm_ups: Sequence[Callable[[], None]] = ()) -> int:
    """Host a node of `build` in every session until SIGTERM or SIGINT; the exit status.

    The `warm_ups` compile what runs per sample; they come first, and the service says so meanwhile.
    """
    set_up_logging(service)
    stop = stop_event()
    settings = BusSettings()
    logger.info(event("started", router=settings.router, site=settings.site))
    bus = Bus.open_when_ready(settings, service, stop)
    if bus is None:
        return 0
    with bus:
        if warm_ups and not prepare(bus, warm_ups, stop):
            return 0
        NodeService(bus, build, stop).run()
    logger.info(event("stopped"))
    return 0


class NodeService:
    """Sessions come by their tokens; each gets its node, all share one loop."""

    def __init__(self, bus: Bus, build: NodeFactory, stop: threading.Event) -> None:
        self._bus = bus
        self._build = build
        self._loop = EventLoop(bus, stop=stop)
        self._sessions: dict[str, NodeSession] = {}
        self._known: set[str] = set()
        self._rejections = RejectionCounter()
        self._health: tuple[list[SessionHealth], list[Rejection]] = ([], [])

    def run(self) -> None:
        """Work until stopped, then freeze every session and leave."""
        loop, site = self._loop, self._bus.settings.site
        loop.every(TICK_S, self._tick)
        loop.every(1.0, self._survey)
        loop.subscribe(progress_key(site, "*", "*"), self._take_progress)
        health = HealthReporter(
            self._bus,
            queue=loop.queue,
            sessions=lambda: self._health[0],
            rejections=lambda: self._health[1],
            errors=lambda: loop.errors,
        )
        self._watch = SessionWatch(self._bus, self._on_loop(self._open), self._on_loop(self._forget))
        loop.run()
        self._freeze_all()
        self._watch.close()
        for hosted in self._sessions.values():
            hosted.close()
        loop.close()
        health.close()

    def _on_loop(self, action: Callable[[Argument], None]) -> Callable[[Argument], None]:
        return lambda argument: self._loop.post(lambda: action(argument))

    def _open(self, description: SessionDescription) -> None:
        session = description.session
        if session in self._known:
            return
        self._known.add(session)

        def work() -> HostedNode | None:
            try:
                return open_host(self._bus, self._bus.service, self._build, description)
            except Exception:  # noqa: BLE001 - a description this node cannot serve; the others go on
                self._loop.report_error("open", session=session)
                return None

        self._loop.background(work, self._start)

    def _start(self, host: HostedNode | None) -> None:
        if host is None or host.ended or host.session not in self._known:
            return
        logger.info(event("session_opened", session=host.session))
        self._sessions[host.session] = NodeSession(self._loop, host)

    def _forget(self, session: str) -> None:
        """The token stayed away: the producer is gone, or done."""
        self._known.discard(session)
        hosted = self._sessions.get(session)
        if hosted is not None and not hosted.host.ended:
            logger.warning(event("session_gone", session=session, captured_ns=hosted.host.captured_ns))
            hosted.freeze(time.monotonic())
            hosted.tick(time.monotonic())
            self._close(session)

    def _close(self, session: str) -> None:
        hosted = self._sessions.pop(session)
        hosted.close()
        logger.info(event("session_closed", session=session))

    def _tick(self) -> None:
        now = time.monotonic()
        for session, hosted in list(self._sessions.items()):
            hosted.tick(now)
            if hosted.is_over(now):
                self._close(session)

    def _survey(self) -> None:
        """What Health says, taken on the loop's thread, as it asks the nodes."""
        sessions = [hosted.health() for hosted in self._sessions.values()]
        self._health = (sessions, [*self._rejections.report(), *self._watch.rejections.report()])

    def _take_progress(self, received: Received) -> None:
        _, session, reader = received.key.rsplit("/", 2)
        hosted = self._sessions.get(session)
        if hosted is None:
            return
        try:
            hosted.note_progress(reader, Progress.model_validate_json(received.payload))
        except ValueError:
            self._rejections.add(f"progress/{reader}", Reason.UNDECODABLE)

    def _freeze_all(self) -> None:
        now = time.monotonic()
        for hosted in self._sessions.values():
            hosted.freeze(now)
        self._loop.run_for(FAREWELL_S, lambda: all(hosted.is_frozen() for hosted in self._sessions.values()))
