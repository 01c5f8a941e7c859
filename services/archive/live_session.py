"""One session while it runs: what is expected of it, and how far its recording has come."""

from dataclasses import dataclass, field
from enum import Enum, auto
from pathlib import Path

from schemas.checkpoint import StreamPosition
from schemas.health import Progress, Reason, Rejection, SessionHealth
from schemas.session import SessionDescription
from schemas.signals import SIGNALS, Quality
from services.archive.writer import Durable, SessionWriter
from services.bus.publisher import StreamPublisher
from services.bus.receiver import StreamReceiver
from services.flow.message import Stream
from services.flow.raw_streams import raw_streams


class Phase(Enum):
    """Where the recording of a live session stands."""

    OPENING = auto()
    RECORDING = auto()
    CLOSING = auto()
    WAITING = auto()
    DONE = auto()


def expected_streams(description: SessionDescription) -> tuple[Stream, ...]:
    """Every stream of the session that is archived: what its source delivers, and what the services compute."""
    computed = [
        Stream(signal, signal.producer)
        for signal in SIGNALS
        if signal.archived == "derived" and signal.quality is Quality.LOSSLESS
    ]
    return (*raw_streams(description), *computed)


@dataclass
class LiveSession:
    """A session whose token is there. `handed` is how far the streams have been handed to the recorder."""

    description: SessionDescription
    folder: Path
    streams: tuple[Stream, ...]
    phase: Phase = Phase.OPENING
    writer: SessionWriter | None = None
    receivers: list[StreamReceiver] = field(default_factory=list)
    handed: dict[str, StreamPosition] = field(default_factory=dict)
    gaps: StreamPublisher | None = None
    durable: Durable = field(default_factory=Durable)
    paused: bool = False
    gone: bool = False
    trouble: str | None = None
    reported: Durable | None = None
    reported_s: float = 0.0

    @property
    def session(self) -> str:
        """The session's id."""
        return self.description.session

    @property
    def missing_ends(self) -> list[str]:
        """Streams whose end is not safe yet."""
        return [stream.name for stream in self.streams if stream.name not in self.durable.ended]

    def refresh(self) -> None:
        """Look at what the writer has brought to the disk."""
        if self.writer is not None:
            self.durable = self.writer.durable

    def progress_due(self, monotonic_s: float, repeat_s: float) -> Progress | None:
        """What to report now; None when it is known."""
        if self.durable is self.reported and monotonic_s - self.reported_s < repeat_s:
            return None
        self.reported, self.reported_s = self.durable, monotonic_s
        return Progress(
            service="archive",
            captured_ns=self.durable.captured_ns,
            positions=self.durable.positions,
            ended=not self.missing_ends,
        )

    def health(self) -> SessionHealth:
        """The session as the archive sees it."""
        rejections = [item for receiver in self.receivers for item in receiver.rejections.report()]
        if self.writer is not None:
            rejections += [
                Rejection(subject=subject, reason=reason, count=count)
                for (subject, reason), count in list(self.writer.counts.refused.items())
            ]
        if self.phase is Phase.WAITING:
            rejections.append(Rejection(subject=self.session, reason=Reason.NOT_RECORDED, count=1))
        return SessionHealth(
            session=self.session,
            captured_ns=self.durable.captured_ns,
            inputs=[receiver.count() for receiver in self.receivers],
            rejections=rejections,
        )
