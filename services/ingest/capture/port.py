"""A UDP port that capture PCs send to: who may, what is no frame, and who listens at present."""

import logging
import socket
import threading
import time
import traceback
from collections import deque
from typing import NamedTuple, Protocol

from schemas.health import Reason, Rejection
from services.bus.logs import event
from services.flow.rejections import RejectionCounter
from services.ingest.capture.datagram import MOST_BYTES, BadDatagram, CameraFrame, decode_frame
from services.ingest.capture.parameters import CAPTURE, CaptureParameters
from services.ingest.capture.settings import CaptureSettings
from services.ingest.errors import SourceError

RECEIVE_BUFFER_BYTES = 1 << 20
"""Two seconds of six bodies, while this thread waits for its turn."""

logger = logging.getLogger(__name__)


class PortUnavailable(SourceError):
    """A port that cannot be listened on."""


class Listener(Protocol):
    """A session on a port. Called by the port's thread; times are monotonic ns."""

    def take(self, frame: CameraFrame, arrival_ns: int) -> None:
        """A frame came."""

    def new_sender(self) -> None:
        """The frames from here on are another computer's."""

    def tick(self, now_ns: int) -> None:
        """Time passes."""


class Arrival(NamedTuple):
    """A frame with the monotonic time at which it came, ns."""

    arrival_ns: int
    frame: CameraFrame


class CapturePort:
    """One port with a thread of its own. The newest frames are kept for whoever asks what is being sent.

    Raises PortUnavailable.
    """

    def __init__(self, port: int, settings: CaptureSettings, parameters: CaptureParameters = CAPTURE) -> None:
        self.port = port
        self._settings = settings
        self._parameters = parameters
        self._lock = threading.Lock()
        self._rejections = RejectionCounter()
        self._recent: deque[Arrival] = deque(maxlen=parameters.look_frames)
        self._complaint: str | None = None
        self._sender: tuple[str, int] | None = None
        self._heard_ns = 0
        self._listener: Listener | None = None
        self._closing = threading.Event()
        self._socket = _bound(settings.skeleton_host, port)
        self._socket.settimeout(parameters.tick_s)
        self._thread = threading.Thread(target=self._receive, name=f"port-{port}", daemon=True)
        self._thread.start()

    def recent(self) -> list[Arrival]:
        """The newest frames of the present sender, oldest first; none while nothing is being sent."""
        with self._lock:
            since_ns = time.monotonic_ns() - self._parameters.sending_s * 1e9
            return [arrival for arrival in self._recent if arrival.arrival_ns >= since_ns]

    def complaint(self) -> str | None:
        """What was wrong with the last datagram that was no frame."""
        with self._lock:
            return self._complaint

    def listen(self, listener: Listener) -> None:
        """Hand frames to a session from now on. Raises PortUnavailable while another one has them."""
        with self._lock:
            if self._listener is not None:
                raise PortUnavailable(f"another session listens on port {self.port}; stop that one first")
            self._listener = listener

    def leave(self, listener: Listener) -> None:
        """Hand it no more frames. It may be called once more meanwhile."""
        with self._lock:
            if self._listener is listener:
                self._listener = None

    def rejections(self) -> list[Rejection]:
        """Datagrams that were not used, by reason."""
        with self._lock:
            return self._rejections.report()

    def close(self) -> None:
        """Listen no more."""
        self._closing.set()
        self._thread.join()
        self._socket.close()

    def _receive(self) -> None:
        while not self._closing.is_set():
            try:
                self._receive_one()
            except Exception:  # noqa: BLE001 - the port serves sessions to come
                logger.error(event("error", where=f"port {self.port}", trace=traceback.format_exc()))
                self._closing.wait(self._parameters.tick_s)

    def _receive_one(self) -> None:
        try:
            datagram, sender = self._socket.recvfrom(MOST_BYTES + 1)
        except TimeoutError:
            datagram, sender = b"", ("", 0)
        now_ns = time.monotonic_ns()
        if sender[1]:
            self._take(datagram, sender[:2], now_ns)
        with self._lock:
            listener = self._listener
        if listener is not None:
            listener.tick(now_ns)

    def _take(self, datagram: bytes, sender: tuple[str, int], now_ns: int) -> None:
        if not self._settings.may_send(sender[0]) or not self._is_its_turn(sender, now_ns):
            self._reject(Reason.UNKNOWN_SENDER, "it came from a computer that may not send, or not while another does")
            return
        try:
            frame = decode_frame(datagram)
        except BadDatagram as error:
            self._reject(error.reason, str(error))
            return
        is_new = sender != self._sender
        self._sender, self._heard_ns = sender, now_ns
        with self._lock:
            listener = self._listener
            if is_new:
                self._recent.clear()
            self._recent.append(Arrival(now_ns, frame))
        if listener is not None:
            if is_new:
                listener.new_sender()
            listener.take(frame, now_ns)

    def _is_its_turn(self, sender: tuple[str, int], now_ns: int) -> bool:
        """One sender at a time: two cameras on one port would be one body at two places."""
        return sender == self._sender or now_ns - self._heard_ns > self._parameters.other_sender_s * 1e9

    def _reject(self, reason: Reason, says: str) -> None:
        with self._lock:
            self._rejections.add(f"port {self.port}", reason)
            self._complaint = says


def _bound(host: str, port: int) -> socket.socket:
    """A UDP socket on that address. Raises PortUnavailable, saying what to do."""
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
        bound = socket.socket(family, kind, protocol)
        try:
            bound.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, RECEIVE_BUFFER_BYTES)
            bound.bind(address)
        except OSError:
            bound.close()
            raise
    except OSError as error:
        raise PortUnavailable(
            f"cannot listen on {host} port {port} ({error.strerror}); choose another port or check AMBULA_SKELETON_HOST"
        ) from error
    return bound
