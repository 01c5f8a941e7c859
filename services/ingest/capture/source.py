"""A depth camera as a source of a live session."""

import dataclasses
import logging
import threading
import time
from collections import deque
from collections.abc import Iterator

from schemas.conditions import UNSAID
from schemas.health import Reason, Rejection, StreamCount
from schemas.session import CameraDescription, SessionDescription
from schemas.vocabulary import CameraKind, Task
from services.bus.logs import event
from services.flow.rejections import RejectionCounter
from services.ingest.capture.datagram import CameraFrame
from services.ingest.capture.first_look import body_of, first_look, view_of_frames
from services.ingest.capture.options import CaptureOptions
from services.ingest.capture.ports import CapturePorts
from services.ingest.capture.reader import FrameReader
from services.ingest.choices import usual_estimator
from services.ingest.driver import SourceMessage
from services.ingest.errors import UnknownSource
from services.ingest.identity import Identity
from services.ingest.skeleton import CameraView

CAMERA = "kinect"
TITLES = {CameraKind.KINECT_V2: "Kinect v2", CameraKind.AZURE_KINECT: "Azure Kinect"}

logger = logging.getLogger(__name__)


class CaptureSource:
    """What a capture PC sends to a port, from now on. The session's time begins when it is made.

    Waits for the first frame, which says what the camera is. Raises NothingArrives, PortUnavailable, WrongAxes or
    WrongUnits.
    """

    def __init__(self, options: CaptureOptions, identity: Identity, ports: CapturePorts) -> None:
        self._options = options
        self._ports = ports
        self._parameters = ports.parameters
        self._lock = threading.Lock()
        self._waiting: deque[SourceMessage] = deque()
        self._rejections = RejectionCounter()
        self._is_open = True
        self._is_ended = False
        self._warned = False
        self._port = ports.use(options.port)
        try:
            seen = first_look(self._port, self._parameters)
            view, floor_m = view_of_frames([arrival.frame for arrival in seen])
            self._reader = FrameReader(CAMERA, view)
            self._began_ns = self._last_ns = time.monotonic_ns()
            self._identity = dataclasses.replace(identity, started_unix_ns=time.time_ns())
            self._description = self._identity.choices.applied(self._described(view, floor_m))
            self._port.listen(self)
        except BaseException:
            self.close()
            raise

    def describe(self) -> SessionDescription:
        """The session, with what the operator chose."""
        return self._description

    def messages(self) -> Iterator[SourceMessage]:
        """Every message as it comes, in a plain loop that waits for it; ends with the source."""
        while not self.is_empty:
            if self.peek() is None:
                time.sleep(self._parameters.tick_s)
            else:
                yield self.pop()
        self.close()

    def rejections(self) -> list[Rejection]:
        """What was not used of this session's frames. What was no frame at all, the port counts."""
        with self._lock:
            return self._rejections.report() + self._reader.rejections()

    def counts(self) -> list[StreamCount]:
        """Frames received and lost."""
        with self._lock:
            return [self._reader.count()]

    def peek(self) -> SourceMessage | None:
        """The next message, if one is there."""
        with self._lock:
            return self._waiting[0] if self._waiting else None

    def pop(self) -> SourceMessage:
        """Take the message that `peek` showed."""
        with self._lock:
            return self._waiting.popleft()

    @property
    def is_empty(self) -> bool:
        """The session is over and everything was taken."""
        with self._lock:
            return self._is_ended and not self._waiting

    def stop(self) -> None:
        """Take no more frames. From any thread or signal handler."""
        self._is_ended = True

    def close(self) -> None:
        """Leave the port. May be called twice."""
        self.stop()
        if self._is_open:
            self._is_open = False
            self._port.leave(self)
            self._ports.release(self._port.port)

    def take(self, frame: CameraFrame, arrival_ns: int) -> None:
        """A frame came; on the port's thread."""
        with self._lock:
            self._last_ns = arrival_ns
            if self._warned:
                self._warned = False
                logger.info(event("camera_back", session=self._identity.session, port=self._port.port))
            self._keep(self._reader.take(frame, max(0, arrival_ns - self._began_ns)))

    def new_sender(self) -> None:
        """The frames from here on are another computer's."""
        with self._lock:
            self._keep(self._reader.new_sender())

    def tick(self, now_ns: int) -> None:
        """Time passes: frames have waited, the camera is silent, the session is over."""
        silent_s = (now_ns - self._last_ns) * 1e-9
        with self._lock:
            self._keep(self._reader.due(now_ns - self._began_ns))
            if silent_s >= self._parameters.warn_after_s and not self._warned:
                self._warned = True
                logger.warning(event("camera_silent", session=self._identity.session, port=self._port.port))
            duration = self._options.duration
            is_over = duration is not None and (now_ns - self._began_ns) * 1e-9 >= duration
            if silent_s >= self._parameters.end_after_s and not self._is_ended:
                logger.warning(event("camera_gone", session=self._identity.session, silent_s=round(silent_s)))
                is_over = True
            self._is_ended = self._is_ended or is_over

    def _keep(self, messages: list[SourceMessage]) -> None:
        if self._is_ended:
            return
        room = self._parameters.most_waiting - len(self._waiting)
        self._waiting.extend(messages[:room])
        self._rejections.add(CAMERA, Reason.QUEUE_FULL, len(messages) - len(messages[:room]))

    def _described(self, view: CameraView, floor_m: float | None) -> SessionDescription:
        camera = CameraDescription(
            name=CAMERA,
            kind=view.kind,
            rate_hz=self._parameters.rate_hz,
            joints=list(view.room_joints),
            floor_m=floor_m,
        )
        return SessionDescription(
            session=self._identity.session,
            title=f"{TITLES[view.kind]} on port {self._options.port}",
            started_unix_ns=self._identity.started_unix_ns,
            origin="device",
            protocol="",
            task=Task.WALK,
            walkway_m=None,
            conditions=UNSAID,
            estimator=usual_estimator(hubs=False, cameras=True),
            walk_path="turning",
            hubs=[],
            cameras=[camera],
            anthropometry=body_of(self._options.height),
            standing=[],
            reference=[],
            duration_s=self._options.duration,
            known_rhythms=[],
        )


def open_device(what: str, identity: Identity, ports: CapturePorts | None) -> CaptureSource:
    """From what follows `device:`, e.g. `kinect?port=7788`. `ports` None: a process without any. Raises SourceError."""
    name, _, options = what.partition("?")
    if name != CAMERA:
        raise UnknownSource(f"device:{name[:40]} is unknown; there is device:{CAMERA}")
    return CaptureSource(CaptureOptions.parse(options), identity, ports if ports is not None else CapturePorts())
