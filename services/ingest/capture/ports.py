"""The ports of a process: those of the deployment are always open, others while a session needs them."""

import logging
import threading
from dataclasses import dataclass

from schemas.health import Rejection
from services.bus.logs import event
from services.ingest.capture.parameters import CAPTURE, CaptureParameters
from services.ingest.capture.port import CapturePort, PortUnavailable
from services.ingest.capture.settings import CaptureSettings

logger = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class OfferedDevice:
    """A camera that a session can be started with."""

    spec: str
    title: str
    is_sending: bool


class CapturePorts:
    """Opens each port once, however many ask. From any thread."""

    def __init__(self, settings: CaptureSettings | None = None, parameters: CaptureParameters = CAPTURE) -> None:
        self._settings = settings if settings is not None else CaptureSettings()
        self.parameters = parameters
        self._lock = threading.Lock()
        self._open: dict[int, CapturePort] = {}
        self._users: dict[int, int] = {}

    def open_configured(self) -> None:
        """Listen on the deployment's ports; one that is taken is told in the log, and the others are heard."""
        if self._settings.is_open_to_all and self._settings.skeleton_ports:
            logger.warning(event("any_sender", host=self._settings.skeleton_host, set="AMBULA_SKELETON_SENDERS"))
        for port in self._settings.skeleton_ports:
            try:
                self.use(port)
            except PortUnavailable as error:
                logger.warning(event("port_unavailable", port=port, reason=str(error)))

    def use(self, port: int) -> CapturePort:
        """The port, opened if need be; give it back with `release`. Raises PortUnavailable."""
        with self._lock:
            if port not in self._open:
                self._open[port] = CapturePort(port, self._settings, self.parameters)
                logger.info(event("port_open", port=port, host=self._settings.skeleton_host))
            self._users[port] = self._users.get(port, 0) + 1
            return self._open[port]

    def release(self, port: int) -> None:
        """One user less; the last one closes it. Nothing happens once all are closed."""
        with self._lock:
            if port not in self._open:
                return
            self._users[port] -= 1
            if self._users[port] == 0:
                self._open.pop(port).close()

    def offered(self) -> list[OfferedDevice]:
        """Ports that somebody configured, and any other that is being sent to."""
        with self._lock:
            ports = list(self._open.values())
        offered = []
        for port in ports:
            recent = port.recent()
            if recent or (self._settings.are_ports_chosen and port.port in self._settings.skeleton_ports):
                title = f"Kinect on port {port.port}" + ("" if recent else " (nothing arrives)")
                offered.append(OfferedDevice(f"device:kinect?port={port.port}", title, bool(recent)))
        return offered

    def rejections(self) -> list[Rejection]:
        """Datagrams that were not used, of all ports that are open."""
        with self._lock:
            ports = list(self._open.values())
        return [rejection for port in ports for rejection in port.rejections()]

    def close(self) -> None:
        """Close all."""
        with self._lock:
            while self._open:
                self._open.popitem()[1].close()
            self._users.clear()
