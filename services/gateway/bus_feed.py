"""What the bus says, handed to hub and keeper. Waits for the router as long as it takes; the pages work without."""

import logging
import threading
from dataclasses import dataclass
from functools import partial

from schemas.gait import GaitEvent, Stride
from schemas.health import Health, Progress
from schemas.kinematics import Calibration
from schemas.metrics import SessionMetrics
from schemas.quality import DataQuality
from schemas.rhythm import LearnedRhythm
from schemas.session import SessionDescription
from schemas.signals import (
    CALIBRATION,
    DATA_QUALITY,
    GAIT_EVENT,
    LEARNED_RHYTHM,
    LIVE_POSE,
    METRICS,
    REPETITION,
    STRIDE,
    TASK_PHASE,
    health_key,
    progress_key,
    stream_key,
)
from schemas.tasks import Repetition, TaskPhase
from services.bus.connection import Bus
from services.bus.health import HealthReporter
from services.bus.logs import event
from services.bus.loop import EventLoop
from services.bus.received import Received
from services.bus.receiver import Delivery, StreamReceiver
from services.bus.sessions import SessionWatch
from services.bus.settings import BusSettings
from services.flow.message import DecodeError, Message, Stream, decode_payload
from services.gateway.live import views
from services.gateway.live.hub import LiveHub
from services.gateway.sessions.keeper import SessionKeeper

SETTLE_S = 1.0
SESSION_WORD = 2
"""Place of the session in a stream's key."""

STREAMS = tuple(
    Stream(signal, signal.producer)
    for signal in (CALIBRATION, DATA_QUALITY, GAIT_EVENT, STRIDE, TASK_PHASE, REPETITION, LEARNED_RHYTHM, METRICS)
)
"""Followed in order and without loss, for every session."""

logger = logging.getLogger(__name__)


@dataclass
class BusLink:
    """The connection, once there is one."""

    bus: Bus | None = None


class BusFeed:
    """One thread that owns the connection. Skeletons take a shortcut: only the newest counts."""

    def __init__(self, settings: BusSettings, link: BusLink, live: LiveHub, keeper: SessionKeeper) -> None:
        self._settings = settings
        self._link = link
        self._live = live
        self._keeper = keeper
        self._stop = threading.Event()
        self._loop: EventLoop | None = None
        self._receivers: dict[str, list[StreamReceiver]] = {}
        self._thread = threading.Thread(target=self._run, name="bus-feed", daemon=True)

    def start(self) -> None:
        """Begin to connect."""
        self._thread.start()

    def stop(self) -> None:
        """Leave the bus."""
        self._stop.set()
        if self._loop is not None:
            self._loop.stop()
        self._thread.join(5.0)

    def _run(self) -> None:
        bus = Bus.open_when_ready(self._settings, "gateway", self._stop)
        if bus is None:
            return
        loop = EventLoop(bus)
        self._loop, self._link.bus = loop, bus
        reporter = HealthReporter(bus, queue=loop.queue, errors=lambda: loop.errors + self._live.undecodable)
        site = bus.settings.site
        bus.subscribe(stream_key(site, "*", LIVE_POSE, "*"), self._take_pose)
        loop.subscribe(health_key(site, "*", "*"), self._take_health)
        loop.subscribe(progress_key(site, "*", "*"), self._take_progress)
        watch = SessionWatch(
            bus,
            on_session=lambda description: loop.post(partial(self._appeared, description)),
            on_gone=lambda session: loop.post(partial(self._gone, session)),
        )
        loop.every(SETTLE_S, self._keeper.settle)
        loop.post(self._keeper.adopt_open_sessions)
        logger.info(event("connected", router=self._settings.router))
        if not self._stop.is_set():
            loop.run()
        watch.close()
        reporter.close()
        loop.close()
        bus.close()

    def _take_pose(self, received: Received) -> None:
        # The end of the stream has no payload.
        if received.payload:
            self._live.pose(received.key.split("/")[SESSION_WORD], received.payload)

    def _take_health(self, received: Received) -> None:
        self._live.health.record(Health.model_validate_json(received.payload))

    def _take_progress(self, received: Received) -> None:
        progress = Progress.model_validate_json(received.payload)
        self._keeper.progressed(received.key.rsplit("/", 2)[1], progress.captured_ns / 1e9)

    def _appeared(self, description: SessionDescription) -> None:
        assert self._loop is not None
        self._keeper.appeared(description)
        if description.session not in self._receivers:
            self._receivers[description.session] = [
                self._loop.receive(description.session, stream, None, self._deliver) for stream in STREAMS
            ]

    def _gone(self, session: str) -> None:
        self._keeper.gone(session)
        for receiver in self._receivers.pop(session, []):
            receiver.close()

    def _deliver(self, delivery: Delivery) -> None:
        try:
            payload = decode_payload(delivery.stream.signal, delivery.envelope, delivery.payload)
        except DecodeError as error:
            logger.warning(event("undecodable", session=delivery.session, stream=delivery.stream.name, error=error))
            return
        self.take(delivery.session, Message(delivery.stream, delivery.envelope, payload))

    def take(self, session: str, message: Message) -> None:
        """A message of a followed stream, in its order."""
        match message.payload:
            case GaitEvent() as contact:
                self._live.tell(session, views.event_view(contact))
            case Stride() as stride:
                self._live.tell(session, views.stride_view(stride))
            case TaskPhase() as phase:
                self._live.tell(session, views.phase_view(phase))
            case Repetition() as repetition:
                self._live.tell(session, views.repetition_view(repetition))
            case Calibration() as calibration:
                self._keeper.calibrated(session, calibration)
            case DataQuality() as quality:
                self._live.measure(session, quality)
            case LearnedRhythm() as rhythm:
                self._keeper.learned(session, rhythm)
            case SessionMetrics() as metrics:
                self._keeper.measured(session, metrics)
