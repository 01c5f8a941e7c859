"""A lossless stream on its way in: in order, each message once, holes filled from the producer's ring."""

import time
from collections.abc import Callable
from typing import NamedTuple

from schemas.health import Reason, StreamCount
from schemas.signals import replay_key, stream_key
from services.bus.connection import Bus
from services.bus.feed import SignalFeed
from services.bus.queue import BoundedQueue
from services.bus.received import Received
from services.bus.replay import question_parameters
from services.flow.inbox import Hole, OrderedInbox
from services.flow.message import DecodeError, Envelope, Stream
from services.flow.position import Position
from services.flow.rejections import RejectionCounter
from services.flow.repair import DEFAULT_TIMES, Repair, RepairTimes
from services.flow.ring import Question, RingExtent


class Delivery(NamedTuple):
    """One message in its order."""

    session: str
    stream: Stream
    envelope: Envelope
    payload: bytes
    recovered: bool


class _Waiting(NamedTuple):
    """What the inbox holds beside an envelope."""

    payload: bytes
    recovered: bool


class StreamReceiver:
    """Made by `EventLoop.receive`; lives on the loop's thread, Zenoh's threads only put into its queue.

    What arrives live before the first answer to the first question is held back, so that a late subscriber
    gets the stream from its beginning, older epochs included.
    """

    def __init__(
        self,
        bus: Bus,
        session: str,
        stream: Stream,
        queue: BoundedQueue,
        position: Position | None,
        feed: SignalFeed,
        deliver: Callable[[Delivery], None],
        times: RepairTimes = DEFAULT_TIMES,
    ) -> None:
        self.session = session
        self.stream = stream
        self.rejections = RejectionCounter()
        self._bus = bus
        self._queue = queue
        self._deliver = deliver
        self._inbox: OrderedInbox[_Waiting] = OrderedInbox(position)
        self._repair = Repair(self._inbox, time.monotonic(), times)
        self._held: list[Received] | None = []
        self._question_number = 0
        self._extents: list[RingExtent] = []
        self._closed = False
        self.name = f"{session}/{stream.name}"
        self._replay_key = replay_key(bus.settings.site, session, stream.signal, stream.source)
        key = stream_key(bus.settings.site, session, stream.signal, stream.source)
        self._subscription = feed.add(key, self.name, self._take_live)
        self.tick(time.monotonic())

    @property
    def position(self) -> Position | None:
        """The last message delivered."""
        return self._inbox.position

    @property
    def is_settled(self) -> bool:
        """The past of the stream has been asked for and delivered."""
        return self._held is None and self._repair.is_settled

    @property
    def closed(self) -> bool:
        """No more deliveries come."""
        return self._closed

    def count(self) -> StreamCount:
        """Received, recovered, duplicated and lost so far."""
        counts = self._inbox.counts
        return StreamCount(
            stream=self.stream.name,
            received=counts.received,
            recovered=counts.recovered,
            duplicated=counts.duplicated,
            lost=counts.lost,
        )

    def take_given_up(self) -> list[Hole]:
        """The spans that nobody has any more, each reported once."""
        given_up = list(self._inbox.given_up)
        self._inbox.given_up.clear()
        return given_up

    def tick(self, monotonic_s: float) -> None:
        """Ask for what is missing, when it is time to."""
        question = None if self._closed else self._repair.question(monotonic_s)
        if question is not None:
            self._ask(question)

    def close(self) -> None:
        """Unsubscribe; what is still queued is ignored."""
        self._closed = True
        self._subscription.close()

    def _ask(self, question: Question) -> None:
        self._question_number += 1
        number = self._question_number
        self._extents = []

        def on_answer(received: Received) -> None:
            self._queue.offer(self.name, self._take_replayed, received)

        def on_done() -> None:
            self._queue.post(self._take_end_of_answer, number)

        self._bus.ask_later(self._replay_key, question_parameters(question), on_answer, on_done)

    def _take_live(self, received: Received) -> None:
        self._repair.heard(time.monotonic())
        if self._held is not None:
            self._held.append(received)
        else:
            self._accept(received, recovered=False)

    def _take_replayed(self, received: Received) -> None:
        if received.attachment:
            self._accept(received, recovered=True)
            return
        try:
            self._extents.append(RingExtent.decode(received.payload))
        except DecodeError:
            self.rejections.add(self.stream.name, Reason.UNDECODABLE)

    def _take_end_of_answer(self, number: int) -> None:
        if number != self._question_number or self._closed:
            return
        held, self._held = self._held or [], None
        for received in held:
            self._accept(received, recovered=False)
        now = time.monotonic()
        self._hand_over(self._repair.answered(now, self._extents))
        self.tick(now)

    def _accept(self, received: Received, *, recovered: bool) -> None:
        if self._closed:
            return
        try:
            envelope = Envelope.decode(received.attachment)
        except DecodeError:
            self.rejections.add(self.stream.name, Reason.UNDECODABLE)
            return
        self._hand_over(self._inbox.accept(envelope, _Waiting(received.payload, recovered), recovered=recovered))

    def _hand_over(self, ready: list[tuple[Envelope, _Waiting]]) -> None:
        for envelope, item in ready:
            if not self._closed:
                self._deliver(Delivery(self.session, self.stream, envelope, item.payload, item.recovered))
