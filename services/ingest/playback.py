"""One session on the bus: its samples read on the side, numbered and sent when they are due, closed at the end."""

import itertools
import logging
from collections import deque
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor

from schemas.health import Progress, SessionHealth
from schemas.imu import ImuBatch
from schemas.session import SessionDescription
from schemas.signals import session_token_key
from schemas.skeleton import SkeletonBatch
from schemas.standing import StandingMark
from services.bus.connection import Bus
from services.bus.logs import event
from services.bus.publisher import StreamPublisher
from services.flow.raw_streams import raw_streams
from services.ingest.batching import Batcher, BatchGovernor
from services.ingest.driver import Feed, LiveSource, Source, SourceMessage
from services.ingest.orders import InvalidOrder, MarkOrder, StartOrder
from services.ingest.pacing import AsFastAsFollowed, AsItComes, Pace, Readers, RealTime
from services.ingest.parameters import PARAMETERS, IngestParameters

ARCHIVE = "archive"

logger = logging.getLogger(__name__)


class ReadAhead:
    """A source's messages, made in chunks by a reading thread so that no slow file holds up another session."""

    def __init__(self, messages: Iterator[SourceMessage], readers: ThreadPoolExecutor, chunk: int) -> None:
        self.exhausted = False
        self._messages = messages
        self._threads = readers
        self._chunk = chunk
        self._ready: deque[SourceMessage] = deque()
        self._reading: Future[list[SourceMessage]] | None = None
        self._more()

    def peek(self) -> SourceMessage | None:
        """The next message, if it is there already. Raises what the source raises."""
        if self._reading is not None and self._reading.done():
            chunk = self._reading.result()
            self._reading = None
            self.exhausted = len(chunk) < self._chunk
            self._ready.extend(chunk)
        if self._reading is None and not self.exhausted and len(self._ready) <= self._chunk:
            self._more()
        return self._ready[0] if self._ready else None

    def pop(self) -> SourceMessage:
        """Take the message that `peek` showed."""
        return self._ready.popleft()

    @property
    def is_empty(self) -> bool:
        """Everything was taken."""
        return self.exhausted and not self._ready

    def close(self) -> None:
        """Read no further than the chunk begun."""
        self.exhausted = True
        self._ready.clear()

    def _more(self) -> None:
        self._reading = self._threads.submit(lambda: list(itertools.islice(self._messages, self._chunk)))


class Playback:
    """A running session. All on the loop's thread. The description must be served before it is made."""

    def __init__(
        self,
        bus: Bus,
        source: Source,
        description: SessionDescription,
        order: StartOrder,
        threads: ThreadPoolExecutor,
        now_s: float,
        parameters: IngestParameters = PARAMETERS,
    ) -> None:
        self.description = description
        self.readers = Readers([stream.name for stream in raw_streams(description)], parameters)
        self.ended_at_s: float | None = None
        self._source = source
        self._parameters = parameters
        self._live = source if isinstance(source, LiveSource) else None
        self._feed: Feed = self._live or ReadAhead(source.messages(), threads, parameters.chunk)
        self._pace = self._pace_of(order, now_s)
        self._governor = BatchGovernor(parameters, ticks=order.ticks)
        self._least_ticks = order.ticks
        self._batcher = Batcher(order.ticks)
        session = description.session
        self._publishers = {stream: StreamPublisher(bus, session, stream) for stream in raw_streams(description)}
        self._token = bus.declare_token(session_token_key(bus.settings.site, session))
        self._captured_ns = 0
        self._marks: list[StandingMark] = []
        self._done_ns: dict[str, int] = {}
        self._last_step_s = now_s
        self._is_recorded = False

    def pump(self, now_s: float) -> None:
        """Send what is due. A source that fails on the way ends its session, with the reason in the log."""
        if self.ended_at_s is not None:
            return
        try:
            self._send_due(now_s)
            if self._feed.is_empty:
                self.end(now_s)
        except Exception as error:
            self.end(now_s)
            raise RuntimeError(f"session {self.description.session}: the source failed: {error}") from error

    def end(self, now_s: float) -> None:
        """Close the streams. Rings and token stay until the session is recorded."""
        if self.ended_at_s is not None:
            return
        self._feed.close()
        for message in self._batcher.flush():
            self._send(message)
        for publisher in self._publishers.values():
            newest = publisher.newest
            publisher.end(0 if newest is None else newest.captured_ns)
        self.ended_at_s = now_s
        logger.info(event("session_ended", session=self.description.session, captured_ns=self._captured_ns))

    def span_of(self, order: MarkOrder) -> tuple[int, int]:
        """Session times from and to, ns, that a mark means. May be called on any thread.

        Raises InvalidOrder for a session whose samples have ended.
        """
        newest_ns = self._captured_ns
        if self.ended_at_s is not None:
            raise InvalidOrder(f"session {order.session} has ended; start it again to mark a standing")
        to_ns = newest_ns if order.at_s is None else min(round(order.at_s * 1e9), newest_ns)
        return max(0, to_ns - round(order.last_s * 1e9)), to_ns

    def mark(self, from_ns: int, to_ns: int) -> None:
        """Send a mark with the next samples: in the stream, so that it is archived and replayed where it was given."""
        self._marks.append(StandingMark(from_ns=from_ns, to_ns=to_ns, given_ns=self._captured_ns))

    def note_progress(self, service: str, progress: Progress, now_s: float) -> None:
        """A reader said how far it is."""
        self.readers.report(service, progress.positions, now_s)
        self.readers.forget()
        if progress.captured_ns > self._done_ns.get(service, -1):
            self._done_ns[service] = progress.captured_ns
            self._last_step_s = now_s
        self._is_recorded |= service == ARCHIVE and progress.ended

    def is_recorded(self) -> bool:
        """The streams are closed, and the archive has them and all that was computed from them."""
        return self.ended_at_s is not None and self._is_recorded

    def is_over(self, now_s: float) -> bool:
        """All is recorded, or nobody has made a step with the session for long.

        Until then its token stays: a service that crashes after the last sample comes back to a session it can find.
        """
        if self.ended_at_s is None:
            return False
        quiet_s = now_s - max(self.ended_at_s, self._last_step_s)
        return self.is_recorded() or quiet_s >= self._parameters.linger_s

    def health(self) -> SessionHealth:
        """What was left out of the source, and what a device's own link lost."""
        return SessionHealth(
            session=self.description.session,
            captured_ns=self._captured_ns,
            inputs=self._live.counts() if self._live is not None else [],
            rejections=self._source.rejections(),
        )

    def close(self) -> None:
        """Take the token back and forget the rings."""
        self._token.close()
        for publisher in self._publishers.values():
            publisher.close()

    def _pace_of(self, order: StartOrder, now_s: float) -> Pace:
        """A device sets its own pace, whatever was asked for."""
        if self._live is not None:
            return AsItComes()
        if order.speed is None:
            return AsFastAsFollowed(self.readers, now_s, self._parameters)
        return RealTime(now_s, order.speed)

    def _send_due(self, now_s: float) -> None:
        limit_ns = self._pace.limit_ns(now_s)
        first = self._feed.peek()
        lag_s = max(0.0, (limit_ns - first.captured_ns) * 1e-9) if first is not None else 0.0
        if self._pace.paced:
            lag_s = max(lag_s, self._reading_lag_s(now_s))
            self._batcher.ticks = max(self._least_ticks, self._governor.observe(now_s, lag_s))
            grown = self._batcher.ticks > self._least_ticks
            self._batcher.longest_ns = round(self._parameters.longest_message_s * 1e9) if grown else None
        for _ in range(self._parameters.most_per_pump):
            message = self._feed.peek()
            if message is None or message.captured_ns > limit_ns:
                return
            for batch in self._batcher.add(self._feed.pop()):
                self._send(batch)

    def _reading_lag_s(self, now_s: float) -> float:
        """How far the slowest reader is behind what was sent, beyond what is usual: fewer messages help it, too."""
        done_ns = self.readers.slowest_ns(now_s)
        if not done_ns:
            return 0.0
        return max(0.0, (self._captured_ns - done_ns) * 1e-9 - self._parameters.told_late_s)

    def _send(self, message: SourceMessage) -> None:
        payload = message.payload
        if self._marks and isinstance(payload, ImuBatch | SkeletonBatch):
            payload = payload.model_copy(update={"marks": payload.marks + self._marks})
            self._marks = []
        envelope = self._publishers[message.stream].send(message.captured_ns, payload)
        self.readers.sent(message.stream.name, envelope.sequence, message.captured_ns)
        self._captured_ns = max(self._captured_ns, message.captured_ns)
