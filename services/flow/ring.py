"""A producer's memory of what it sent lately, to be asked for again by sequence number."""

from collections import deque
from dataclasses import dataclass, field

from services.flow.message import Envelope


@dataclass
class ReplayRing:
    """The last `keep_s` seconds (of captured time) of one stream, at most `most_bytes` of payload."""

    keep_s: float = 60.0
    most_bytes: int = 64 * 1024 * 1024
    _sent: deque[tuple[Envelope, bytes]] = field(default_factory=deque)
    _bytes: int = 0

    def append(self, envelope: Envelope, payload: bytes) -> None:
        """Remember a message; forget what is too old or too much. The newest always stays."""
        self._sent.append((envelope, payload))
        self._bytes += len(payload)
        oldest_kept_ns = envelope.captured_ns - int(self.keep_s * 1e9)
        while len(self._sent) > 1 and (self._sent[0][0].captured_ns < oldest_kept_ns or self._bytes > self.most_bytes):
            self._bytes -= len(self._sent.popleft()[1])

    def between(self, epoch: int | None, first: int, last: int | None) -> list[tuple[Envelope, bytes]]:
        """Messages first..last (both included) of an epoch, in order; None means: any epoch, to the newest."""
        return [
            (envelope, payload)
            for envelope, payload in list(self._sent)
            if (epoch is None or envelope.epoch == epoch)
            and envelope.sequence >= first
            and (last is None or envelope.sequence <= last)
        ]

    def newest(self) -> Envelope | None:
        """Envelope of the last message sent."""
        return self._sent[-1][0] if self._sent else None
