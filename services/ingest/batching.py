"""Several ticks in one message: fewer messages when there is more to do than time for it."""

from dataclasses import dataclass, field

from schemas.imu import ImuBatch, ReferenceBatch, SensorSamples
from schemas.skeleton import SkeletonBatch
from services.flow.message import Stream
from services.ingest.driver import SourceMessage
from services.ingest.parameters import PARAMETERS, IngestParameters


@dataclass
class Batcher:
    """Joins `ticks` consecutive messages of each stream, fewer where they would span more than `longest_ns`.

    Both may change at any time.
    """

    ticks: int = 1
    longest_ns: int | None = None
    _held: dict[Stream, tuple[int, int, SourceMessage]] = field(default_factory=dict)

    def add(self, message: SourceMessage) -> list[SourceMessage]:
        """The next message of its stream; what is now complete."""
        count, first_ns, so_far = self._held.pop(message.stream, (0, message.captured_ns, None))
        message = message if so_far is None else joined(so_far, message)
        if count + 1 >= self.ticks or self._is_long(count, message.captured_ns - first_ns):
            return [message]
        self._held[message.stream] = (count + 1, first_ns, message)
        return []

    def _is_long(self, periods: int, span_ns: int) -> bool:
        """Whether one more would be too many."""
        return self.longest_ns is not None and periods > 0 and span_ns + span_ns // periods > self.longest_ns

    def flush(self) -> list[SourceMessage]:
        """What is incomplete, at the end."""
        rest = [message for _, _, message in self._held.values()]
        self._held.clear()
        return rest


@dataclass
class BatchGovernor:
    """How many ticks a message should hold, from how far a paced session lags behind its clock.

    One tick while it keeps up. After a second behind it takes one more, up to the most; after a while in time one
    less, and where that was too few, it waits twice as long before it tries again. Replays without a pace have no lag
    and keep one tick, so their messages are those of a plain loop.
    """

    parameters: IngestParameters = PARAMETERS
    ticks: int = 1
    _since_s: float | None = None
    _patience_s: float | None = None
    _has_shrunk: bool = False

    def observe(self, now_s: float, lag_s: float) -> int:
        """`now_s` monotonic; `lag_s` how late the oldest message that is due would be sent, or is read."""
        if self._since_s is None:
            self._since_s, self._patience_s = now_s, self.parameters.shrink_after_s
        passed, patience_s = now_s - self._since_s, self._patience_s or 0.0
        if self.parameters.lag_in_time_s < lag_s < self.parameters.lag_behind_s:
            self._since_s = now_s
        elif lag_s >= self.parameters.lag_behind_s and passed >= self.parameters.grow_after_s:
            self.ticks = min(self.ticks + 1, self.parameters.most_ticks)
            self._since_s = now_s
            if self._has_shrunk:
                self._patience_s = min(2.0 * patience_s, self.parameters.longest_patience_s)
            self._has_shrunk = False
        elif lag_s <= self.parameters.lag_in_time_s and passed >= patience_s:
            self._has_shrunk = self.ticks > 1
            self.ticks = max(self.ticks - 1, 1)
            self._since_s = now_s
        return self.ticks


def joined(first: SourceMessage, second: SourceMessage) -> SourceMessage:
    """Two consecutive messages of one stream as one."""
    match first.payload, second.payload:
        case ImuBatch() as a, ImuBatch() as b:
            sensors = [_joined_samples(x, y) for x, y in zip(a.sensors, b.sensors, strict=True)]
            return second._replace(payload=ImuBatch(sensors=sensors, marks=a.marks + b.marks))
        case SkeletonBatch() as a, SkeletonBatch() as b:
            return second._replace(payload=_joined_frames(a, b))
        case ReferenceBatch() as a, ReferenceBatch() as b:
            batch = ReferenceBatch(captured_ns=a.captured_ns + b.captured_ns, values=a.values + b.values)
            return second._replace(payload=batch)
    raise TypeError(f"messages of {first.stream.name} cannot be joined")


def _joined_frames(a: SkeletonBatch, b: SkeletonBatch) -> SkeletonBatch:
    return SkeletonBatch(
        captured_ns=a.captured_ns + b.captured_ns,
        body=a.body + b.body,
        people=a.people + b.people,
        position=a.position + b.position,
        state=a.state + b.state,
        marks=a.marks + b.marks,
    )


def _joined_samples(a: SensorSamples, b: SensorSamples) -> SensorSamples:
    return SensorSamples(
        captured_ns=a.captured_ns + b.captured_ns,
        angular_velocity=a.angular_velocity + b.angular_velocity,
        specific_force=a.specific_force + b.specific_force,
    )
