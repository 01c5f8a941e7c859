"""The ingest process: takes orders, runs the sessions they ask for, says how it is."""

import json
import logging
import threading
import time
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from schemas.health import Progress, Reason, Rejection, SessionHealth
from schemas.session import SessionDescription
from schemas.signals import command_key, description_key, progress_key, service_token_key
from services.bus.connection import Bus
from services.bus.health import HealthReporter
from services.bus.lifetime import stop_event
from services.bus.logs import event, set_up_logging
from services.bus.loop import EventLoop
from services.bus.received import Received
from services.bus.settings import BusSettings
from services.flow.rejections import RejectionCounter
from services.ingest.capture.ports import CapturePorts
from services.ingest.data import find_data
from services.ingest.driver import LiveSource, Source
from services.ingest.errors import SourceError
from services.ingest.manifest import Manifest, load_manifest
from services.ingest.orders import InvalidOrder, MarkOrder, StartOrder, StopOrder, parse_order, refusal
from services.ingest.parameters import PARAMETERS, IngestParameters
from services.ingest.playback import Playback
from services.ingest.source import known_recordings, open_chosen
from services.ingest.starts import Starts

SERVICE = "ingest"
SAMPLE_READERS = ("estimation", "archive")
"""Services that read every sample of a session; while one is running, an unpaced replay waits for it."""

READING_THREADS = 2

logger = logging.getLogger(__name__)


def run_ingest() -> int:
    """Serve until SIGTERM or SIGINT; the exit status."""
    set_up_logging(SERVICE)
    stop = stop_event()
    settings = BusSettings()
    logger.info(event("started", router=settings.router, site=settings.site))
    bus = Bus.open_when_ready(settings, SERVICE, stop)
    if bus is None:
        return 0
    with bus:
        IngestService(bus, stop).run()
    logger.info(event("stopped"))
    return 0


class IngestService:
    """Orders come on the bus's threads and open their source there; everything that runs, runs on one loop."""

    def __init__(
        self,
        bus: Bus,
        stop: threading.Event,
        parameters: IngestParameters = PARAMETERS,
        ports: CapturePorts | None = None,
    ) -> None:
        self._bus = bus
        self._parameters = parameters
        self._loop = EventLoop(bus, stop=stop)
        self._threads = ThreadPoolExecutor(READING_THREADS, thread_name_prefix="reading")
        self._descriptions: dict[str, SessionDescription] = {}
        self._starts = Starts()
        self._lock = threading.Lock()
        self._running: dict[str, Playback] = {}
        self._running_services: dict[str, set[str]] = {service: set() for service in SAMPLE_READERS}
        self._rejections = RejectionCounter()
        self._ports = ports if ports is not None else CapturePorts()
        self._survey: tuple[list[SessionHealth], list[Rejection]] = ([], [])

    def run(self) -> None:
        """Work until stopped; then close all streams, give the archive a moment, and leave."""
        bus, loop, site = self._bus, self._loop, self._bus.settings.site
        loop.every(self._parameters.pump_s, self._pump)
        loop.every(1.0, self._take_stock)
        loop.subscribe(progress_key(site, "*", "*"), self._take_progress)
        health = HealthReporter(
            bus,
            queue=loop.queue,
            sessions=lambda: self._survey[0],
            rejections=lambda: self._survey[1],
            errors=lambda: loop.errors,
        )
        handles = [bus.serve(description_key(site, "*"), self._describe)]
        handles += [
            bus.serve(command_key(site, SERVICE, command), self._answering(carry_out))
            for command, carry_out in self._commands().items()
        ]
        handles += [
            bus.watch_tokens(service_token_key(site, service, "*"), self._service_seen) for service in SAMPLE_READERS
        ]
        self._ports.open_configured()
        loop.run()
        self._end_all()
        for handle in handles:
            handle.close()
        self._ports.close()
        self._threads.shutdown(wait=False, cancel_futures=True)
        loop.close()
        health.close()

    def _commands(self) -> dict[str, Callable[[bytes], bytes]]:
        return {"start": self._start, "stop": self._stop, "mark": self._mark, "sources": self._sources}

    def _answering(
        self, carry_out: Callable[[bytes], bytes]
    ) -> Callable[[str, dict[str, str], bytes], Iterable[Received]]:
        """A refused order is an answer like any other, and never the end of the process."""

        def handle(key: str, _parameters: dict[str, str], body: bytes) -> Iterable[Received]:
            try:
                answer = carry_out(body)
            except (SourceError, OSError) as error:
                logger.warning(event("refused", command=key.rpartition("/")[2], reason=str(error)))
                answer = refusal(error)
            return [Received(key, b"", answer)]

        return handle

    def _start(self, body: bytes) -> bytes:
        order = parse_order(StartOrder, body)
        return self._starts.once(order, lambda: self._begin(order)).model_dump_json().encode()

    def _begin(self, order: StartOrder) -> SessionDescription:
        if order.session in self._descriptions:
            raise InvalidOrder(f"session {order.session} runs already; stop it or choose another id")
        source = open_chosen(order.source, order.choices, session=order.session, ports=self._ports)
        description = source.describe()
        with self._lock:
            is_taken = description.session in self._descriptions
            if not is_taken:
                self._descriptions[description.session] = description
        if is_taken:
            if isinstance(source, LiveSource):
                source.close()
            raise InvalidOrder(f"session {description.session} was started by another order just now")
        self._loop.post(lambda: self._play(source, description, order))
        return description

    def _play(self, source: Source, description: SessionDescription, order: StartOrder) -> None:
        now_s = time.monotonic()
        playback = Playback(self._bus, source, description, order, self._threads, now_s, self._parameters)
        for service, instances in self._running_services.items():
            if instances:
                playback.readers.expect(service, now_s)
        self._running[description.session] = playback
        logger.info(event("session_started", session=description.session, source=order.source, speed=order.speed))

    def _mark(self, body: bytes) -> bytes:
        order = parse_order(MarkOrder, body)
        playback = self._running.get(order.session)
        if playback is None:
            raise InvalidOrder(f"session {order.session[:80]} does not run here")
        from_ns, to_ns = playback.span_of(order)
        self._loop.post(lambda: playback.mark(from_ns, to_ns))
        logger.info(event("standing_marked", session=order.session, from_ns=from_ns, to_ns=to_ns))
        return json.dumps({"session": order.session, "from_s": from_ns / 1e9, "to_s": to_ns / 1e9}).encode()

    def _stop(self, body: bytes) -> bytes:
        order = parse_order(StopOrder, body)
        if order.session not in self._descriptions:
            raise InvalidOrder(f"session {order.session[:80]} does not run here")
        self._loop.post(lambda: self._end(order.session))
        return json.dumps({"session": order.session}).encode()

    def _end(self, session: str) -> None:
        if session in self._running:
            self._running[session].end(time.monotonic())

    def _sources(self, _body: bytes) -> bytes:
        """Recordings at hand: those whose manifest is right and whose data is here. And the cameras."""
        found = []
        for name, path in known_recordings().items():
            try:
                manifest = load_manifest(path)
                find_data(manifest.data, path.resolve().parent)
            except SourceError:
                continue
            found.append({"name": name, "title": manifest.title, "duration_s": None, **_what_is_in(manifest)})
        devices = [
            {"name": each.spec, "title": each.title, "sending": each.is_sending} for each in self._ports.offered()
        ]
        return json.dumps({"recordings": found, "devices": devices}).encode()

    def _describe(self, key: str, _parameters: dict[str, str], _body: bytes) -> Iterable[Received]:
        site, asked = self._bus.settings.site, key.rpartition("/")[2]
        return [
            Received(description_key(site, session), b"", description.model_dump_json().encode())
            for session, description in list(self._descriptions.items())
            if asked in (session, "*")
        ]

    def _pump(self) -> None:
        """Every session gets its turn, whatever became of the one before it."""
        now_s = time.monotonic()
        for session, playback in list(self._running.items()):
            try:
                playback.pump(now_s)
            except Exception:  # noqa: BLE001 - a source's own fault; the others go on
                self._loop.report_error("pump", session=session)
            if playback.is_over(now_s):
                self._forget(session)

    def _forget(self, session: str) -> None:
        self._running.pop(session).close()
        with self._lock:
            del self._descriptions[session]
        logger.info(event("session_closed", session=session))

    def _service_seen(self, key: str, alive: bool) -> None:
        _, service, instance = key.rsplit("/", 2)
        self._loop.post(lambda: self._note_service(service, instance, alive=alive))

    def _note_service(self, service: str, instance: str, *, alive: bool) -> None:
        instances = self._running_services[service]
        if alive:
            instances.add(instance)
        else:
            instances.discard(instance)

    def _take_progress(self, received: Received) -> None:
        _, session, service = received.key.rsplit("/", 2)
        playback = self._running.get(session)
        if playback is None:
            return
        try:
            progress = Progress.model_validate_json(received.payload)
        except ValueError:
            self._rejections.add(f"progress/{service}", Reason.UNDECODABLE)
            return
        playback.note_progress(service, progress, time.monotonic())

    def _take_stock(self) -> None:
        """What Health says, gathered on the loop's thread."""
        rejections = self._rejections.report() + self._ports.rejections()
        self._survey = ([playback.health() for playback in self._running.values()], rejections)

    def _end_all(self) -> None:
        """Tokens and rings go with the connection, which is closed next."""
        now_s = time.monotonic()
        for playback in self._running.values():
            playback.end(now_s)
        if self._running_services["archive"]:
            self._loop.run_for(
                self._parameters.farewell_s, lambda: all(each.is_recorded() for each in self._running.values())
            )


def _what_is_in(manifest: Manifest) -> dict[str, Any]:
    """Task and streams of a recording, as its manifest says."""
    return {
        "task": manifest.task,
        "hubs": [hub.name for hub in manifest.hub],
        "cameras": [camera.name for camera in manifest.camera],
    }
