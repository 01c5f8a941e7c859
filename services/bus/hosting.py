"""One node of one session on the bus: where it starts, what it takes and sends, how it is frozen."""

import logging
import time

from schemas.checkpoint import Checkpoint
from schemas.health import Progress, Reason, Rejection, SessionHealth
from schemas.session import SessionDescription
from schemas.signals import Quality, checkpoint_key, progress_key, replay_key
from services.bus.connection import Bus, RemoteError
from services.bus.logs import event
from services.bus.loop import EventLoop
from services.bus.publisher import LivePublisher, StreamPublisher
from services.bus.receiver import Delivery
from services.bus.replay import question_parameters
from services.flow.catch_up import CatchUp
from services.flow.checkpoints import ARCHIVE, HeldCheckpoints
from services.flow.host import HostedNode
from services.flow.message import DecodeError, Message, Stream, decode_payload
from services.flow.node import NodeFactory
from services.flow.rejections import RejectionCounter
from services.flow.ring import Question, RingExtent

CHECKPOINT_S = 1.0
PROGRESS_STEP_NS = 1_000_000_000
"""Progress is told each tick (0.1 s) in which this much captured time was done, and else each second."""
REPEAT_S = 5.0
"""Progress is told again when nothing changes, for those who came later or lost it."""
LINGER_S = 60.0
"""Rings stay this long after the end, and after the last step of any reader, when no archive says it has all."""
LONGEST_CATCH_UP_S = 20.0
"""A stream that has not told its past by then is not waited for."""
PATIENCE_S = 5.0
"""For a checkpoint, when the rings no longer have the beginning."""

logger = logging.getLogger(__name__)


def open_host(bus: Bus, service: str, build: NodeFactory, description: SessionDescription) -> HostedNode:
    """The node where it left off, or at the beginning; in the middle, under a larger epoch, if that is all there is.

    Blocks for the answers, and up to `PATIENCE_S` for a checkpoint when the beginning is gone.
    """
    session = description.session
    give_up_at = time.monotonic() + PATIENCE_S
    while True:
        host = HostedNode(service, session, build(description))
        checkpoint = _ask_checkpoint(bus, service, session)
        if checkpoint is not None and _resume(host, checkpoint):
            logger.info(event("resumed", session=session, captured_ns=host.captured_ns))
            return host
        if checkpoint is not None:
            host = HostedNode(service, session, build(description))
        if not any(_begins_late(bus, session, stream) for stream in host.node.streams):
            return host
        if time.monotonic() >= give_up_at:
            epoch = time.time_ns()
            logger.warning(event("started_in_the_middle", session=session, epoch=epoch))
            return HostedNode(service, session, build(description), epoch)
        time.sleep(0.25)


def _ask_checkpoint(bus: Bus, service: str, session: str) -> Checkpoint | None:
    try:
        answers = bus.ask(checkpoint_key(bus.settings.site, session, service))
        checkpoints = [Checkpoint.model_validate_json(answer.payload) for answer in answers]
    except (RemoteError, ValueError) as error:
        logger.warning(event("checkpoint_unreadable", session=session, error=str(error)))
        return None
    return max(checkpoints, key=lambda checkpoint: checkpoint.captured_ns, default=None)


def _resume(host: HostedNode, checkpoint: Checkpoint) -> bool:
    try:
        host.resume(checkpoint)
    except Exception:
        logger.exception(event("checkpoint_refused", session=host.session))
        return False
    return True


def _begins_late(bus: Bus, session: str, stream: Stream) -> bool:
    key = replay_key(bus.settings.site, session, stream.signal, stream.source)
    nothing = question_parameters(Question(None, 0, -1))
    try:
        extents = [RingExtent.decode(answer.payload) for answer in bus.ask(key, nothing)]
    except (RemoteError, DecodeError) as error:
        logger.warning(event("ring_unreadable", session=session, stream=stream.name, error=str(error)))
        return False
    return bool(extents) and min(extent.oldest.sequence for extent in extents) > 0


class NodeSession:
    """A hosted node between its receivers and its publishers. All on the loop's thread."""

    def __init__(self, loop: EventLoop, host: HostedNode) -> None:
        self.host = host
        self.failed = False
        self._loop = loop
        self._bus = loop.bus
        self._rejections = RejectionCounter()
        self._held = HeldCheckpoints()
        self._final: Checkpoint | None = None
        self._ended_at: float | None = None
        self._stepped_at = 0.0
        self._archived = False
        self._frozen_at = time.monotonic()
        self._frozen_inputs = dict(host.inputs)
        self._told_at = 0.0
        self._told: Progress | None = None
        self._opened_at = time.monotonic()
        self._catch_up: CatchUp[Delivery] | None = CatchUp(host.node.streams, lambda each: each.envelope.captured_ns)
        self._publishers = {stream: self._publisher(stream) for stream in host.outputs}
        self._receivers = [
            loop.receive(host.session, stream, host.inputs.get(stream), self._take) for stream in host.node.streams
        ]

    def tick(self, now: float) -> None:
        """Tell progress and freeze, when it is time to."""
        self._drain(now)
        self._tell_progress(now)
        if now - self._frozen_at >= CHECKPOINT_S or (self.host.ended and self._ended_at is None):
            self.freeze(now)
        self._put_checkpoint(self._held.release(now))

    def freeze(self, now: float) -> None:
        """Take a checkpoint if something changed; `tick` puts it once the readers have what was sent before."""
        self._frozen_at = now
        if self.failed or self.host.inputs == self._frozen_inputs:
            return
        self._frozen_inputs = dict(self.host.inputs)
        checkpoint = self.host.checkpoint()
        self._held.add(now, checkpoint)
        if self.host.ended and self._ended_at is None:
            self._ended_at = now
            self._final = checkpoint
            logger.info(event("session_ended", session=self.host.session, captured_ns=self.host.captured_ns))

    def is_frozen(self) -> bool:
        """No checkpoint waits."""
        return self._held.empty

    def is_over(self, now: float) -> bool:
        """The whole session is safe in the archive, or nobody has made a step with it in a minute.

        The own outputs being safe is not enough: a reader that crashes after the end comes back for them.
        """
        if self._ended_at is None:
            return False
        return self._archived or now - max(self._ended_at, self._stepped_at) >= LINGER_S

    def note_progress(self, reader: str, progress: Progress) -> None:
        """Another service said how far it is with this session."""
        if reader == self.host.service:
            return
        if self._held.progress(reader, progress.positions):
            self._stepped_at = time.monotonic()
        self._archived |= reader == ARCHIVE and progress.ended

    def health(self) -> SessionHealth:
        """Counts of the inputs and what was not used."""
        rejections: list[Rejection] = [*self._rejections.report(), *self.host.node.rejections()]
        for receiver in self._receivers:
            rejections += receiver.rejections.report()
            dropped = self._loop.queue.dropped[receiver.name]
            if dropped:
                rejections.append(Rejection(subject=receiver.stream.name, reason=Reason.QUEUE_FULL, count=dropped))
        return SessionHealth(
            session=self.host.session,
            captured_ns=self.host.captured_ns,
            inputs=[receiver.count() for receiver in self._receivers],
            rejections=rejections,
        )

    def close(self) -> None:
        """Leave the streams; the rings are gone. The final checkpoint is put once more, as a put may get lost."""
        if self._held.empty:
            self._put_checkpoint(self._final)
        for receiver in self._receivers:
            receiver.close()
        for publisher in self._publishers.values():
            publisher.close()

    def _take(self, delivery: Delivery) -> None:
        if self._catch_up is None:
            self._accept(delivery)
            return
        self._catch_up.add(delivery.stream, delivery)
        self._drain(time.monotonic())

    def _drain(self, now: float) -> None:
        """Hand over what the streams brought of their past, until they are all in the present."""
        if self._catch_up is None:
            return
        late = now - self._opened_at >= LONGEST_CATCH_UP_S
        settled = [receiver.stream for receiver in self._receivers if late or receiver.is_settled]
        for delivery in self._catch_up.ready(settled):
            self._accept(delivery)
        if self._catch_up.is_over(settled):
            self._catch_up = None

    def _accept(self, delivery: Delivery) -> None:
        if self.failed:
            return
        try:
            payload = decode_payload(delivery.stream.signal, delivery.envelope, delivery.payload)
        except DecodeError:
            self._rejections.add(delivery.stream.name, Reason.UNDECODABLE)
            self.host.skip(delivery.stream, delivery.envelope)
            return
        try:
            messages = self.host.accept(Message(delivery.stream, delivery.envelope, payload))
        except Exception:  # noqa: BLE001 - a bug met in one session must not end the others
            self.failed = True
            self._loop.report_error("node", session=self.host.session, stream=delivery.stream.name)
            return
        for message in messages:
            self._publishers[message.stream].forward(message)

    def _tell_progress(self, now: float) -> None:
        waited = now - self._told_at
        far = self._told is None or self.host.captured_ns - self._told.captured_ns >= PROGRESS_STEP_NS
        if not (far or self.host.ended or waited >= 1.0):
            return
        progress = self._progress()
        if progress != self._told or waited >= REPEAT_S:
            key = progress_key(self._bus.settings.site, self.host.session, self.host.service)
            self._bus.put(key, progress.model_dump_json().encode())
            self._told, self._told_at = progress, now

    def _progress(self) -> Progress:
        positions = {
            stream.name: self.host.inputs[stream].sequence if stream in self.host.inputs else -1
            for stream in self.host.node.streams
        }
        return Progress(
            service=self.host.service,
            captured_ns=self.host.captured_ns,
            positions=positions,
            ended=self.host.ended,
        )

    def _put_checkpoint(self, checkpoint: Checkpoint | None) -> None:
        if checkpoint is not None:
            key = checkpoint_key(self._bus.settings.site, checkpoint.session, checkpoint.service)
            self._bus.put(key, checkpoint.model_dump_json().encode())

    def _publisher(self, stream: Stream) -> StreamPublisher | LivePublisher:
        lossless = stream.signal.quality is Quality.LOSSLESS
        return (StreamPublisher if lossless else LivePublisher)(self._bus, self.host.session, stream)
