"""Streams on their way out."""

from schemas.payload import Payload
from schemas.signals import stream_key
from services.bus.connection import Bus
from services.bus.replay import RingServer, SharedRing
from services.flow.message import Envelope, Message, Stream, encode_payload
from services.flow.ring import ReplayRing


class StreamPublisher:
    """A lossless stream: every message sent is also kept in a ring that answers replays. For one thread."""

    def __init__(self, bus: Bus, session: str, stream: Stream, *, ring: ReplayRing | None = None) -> None:
        self.stream = stream
        self.newest: Envelope | None = None
        self._shared = SharedRing(ring if ring is not None else ReplayRing())
        self._serving = RingServer.of(bus, stream.signal).add(session, stream, self._shared)
        key = stream_key(bus.settings.site, session, stream.signal, stream.source)
        self._put, self._publishing = bus.publish_cached(key)

    def send(self, captured_ns: int, payload: Payload, epoch: int = 0) -> Envelope:
        """Send the next message: numbered 0, 1, 2, ... within its epoch."""
        envelope = self._next(captured_ns, epoch, final=False)
        self.send_encoded(envelope, encode_payload(payload))
        return envelope

    def forward(self, message: Message) -> None:
        """Send a message that is numbered already."""
        self.send_encoded(message.envelope, encode_payload(message.payload))

    def end(self, captured_ns: int) -> None:
        """Close the stream: send its final message."""
        epoch = self.newest.epoch if self.newest is not None else 0
        self.send_encoded(self._next(captured_ns, epoch, final=True), b"")

    def send_encoded(self, envelope: Envelope, payload: bytes) -> None:
        """Send bytes that are a payload already, under a number that is given already."""
        self.newest = envelope
        with self._shared.lock:
            self._shared.ring.append(envelope, payload)
        self._put(payload, envelope.encode())

    def close(self) -> None:
        """Forget the ring and leave the bus."""
        self._serving.close()
        self._publishing.close()

    def _next(self, captured_ns: int, epoch: int, *, final: bool) -> Envelope:
        same = self.newest is not None and self.newest.epoch == epoch
        sequence = self.newest.sequence + 1 if self.newest is not None and same else 0
        return Envelope(epoch, sequence, captured_ns, final)


class LivePublisher:
    """A live stream: the newest counts, nothing is kept."""

    def __init__(self, bus: Bus, session: str, stream: Stream) -> None:
        self.stream = stream
        self._bus = bus
        self._key = stream_key(bus.settings.site, session, stream.signal, stream.source)

    def forward(self, message: Message) -> None:
        """Send a message that is numbered already."""
        self._bus.put(self._key, encode_payload(message.payload), message.envelope.encode())

    def close(self) -> None:
        """Nothing was declared."""
