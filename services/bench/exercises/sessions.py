"""A simulated person before a camera, through the whole chain, with the truth beside it."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from schemas.gait import GaitEvent, Stride
from schemas.imu import ReferenceBatch
from schemas.metrics import SessionMetrics
from schemas.tasks import Repetition
from services.cli.assembly import build_chain
from services.ingest.source import iter_messages, open_source

Array = NDArray[np.float64]


@dataclass
class SeenSession:
    """What came out of a session, and its truth."""

    channels: list[str]
    repetitions: list[Repetition] = field(default_factory=list)
    strides: list[Stride] = field(default_factory=list)
    events: list[GaitEvent] = field(default_factory=list)
    metrics: SessionMetrics | None = None
    _times_ns: list[int] = field(default_factory=list)
    _values: list[list[float | None]] = field(default_factory=list)

    @property
    def time_s(self) -> Array:
        """(n,) s of the truth."""
        return np.array(self._times_ns) / 1e9

    def truth(self, channel: str) -> Array:
        """(n,) of one channel, NaN where it says nothing."""
        at = self.channels.index(channel)
        return np.array([np.nan if row[at] is None else row[at] for row in self._values], dtype=np.float64)

    def take(self, payload: object) -> None:
        """What the chain or the source put out."""
        if isinstance(payload, ReferenceBatch):
            self._times_ns += payload.captured_ns
            self._values += payload.values
        elif isinstance(payload, Repetition):
            self.repetitions.append(payload)
        elif isinstance(payload, Stride):
            self.strides.append(payload)
        elif isinstance(payload, GaitEvent):
            self.events.append(payload)
        elif isinstance(payload, SessionMetrics):
            self.metrics = payload


def through_chain(spec: str) -> SeenSession:
    """Run a source to its end. Raises SourceError when it cannot be read."""
    source = open_source(spec)
    description = source.describe()
    chain, session = build_chain(description), SeenSession([channel.name for channel in description.reference])
    for message in iter_messages(source):
        if isinstance(message.payload, ReferenceBatch):
            session.take(message.payload)
            continue
        for produced in chain.push(message):
            session.take(produced.payload)
    return session
