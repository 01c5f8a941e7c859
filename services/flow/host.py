"""A node with its place in its streams: numbers its outputs, closes them, freezes and resumes."""

from schemas.checkpoint import Checkpoint
from services.flow.message import Envelope, Message, Output, Stream
from services.flow.node import Node
from services.flow.position import Position


class HostedNode:
    """Runs one node of one session.

    Outputs are numbered from zero in the newest epoch of the inputs, so a node that starts again from a
    checkpoint, or from the beginning of its inputs, sends the same messages under the same numbers. One that has
    to start in the middle is given a larger `epoch`, so that its numbers are not taken for the earlier ones.
    """

    def __init__(self, service: str, session: str, node: Node, epoch: int = 0) -> None:
        self.service = service
        self.session = session
        self.node = node
        self.epoch = epoch
        self.captured_ns = 0
        self.inputs: dict[Stream, Position] = {}
        self._streams = {signal.name: Stream(signal, service) for signal in node.outputs}
        self.outputs = {stream: Position(0, -1, ended=False) for stream in self._streams.values()}

    @property
    def ended(self) -> bool:
        """Every input stream has ended and the outputs are closed."""
        return all(position.ended for position in self.outputs.values())

    def accept(self, message: Message) -> list[Message]:
        """Take the next message of a stream, in order; the messages it leads to, numbered."""
        self.skip(message.stream, message.envelope)
        if not message.envelope.final:
            return [self._number(output) for output in self.node.step(message)]
        if not all(stream in self.inputs and self.inputs[stream].ended for stream in self.node.streams):
            return []
        last = [self._number(output) for output in self.node.finish()]
        return last + [self._close(stream) for stream in self.outputs]

    def skip(self, stream: Stream, envelope: Envelope) -> None:
        """Count the next message of a stream as done without showing it to the node: it could not be read."""
        self.inputs[stream] = Position(envelope.epoch, envelope.sequence, envelope.final)
        if envelope.epoch > self.epoch:
            self.epoch = envelope.epoch
        if envelope.captured_ns > self.captured_ns:
            self.captured_ns = envelope.captured_ns

    def checkpoint(self) -> Checkpoint:
        """Freeze between two messages."""
        return Checkpoint(
            service=self.service,
            session=self.session,
            captured_ns=self.captured_ns,
            inputs={stream.name: place.written() for stream, place in self.inputs.items()},
            outputs={stream.name: place.written() for stream, place in self.outputs.items()},
            state=self.node.snapshot(),
        )

    def resume(self, checkpoint: Checkpoint) -> None:
        """Go on as the node that was frozen. Raises ValueError when the checkpoint is another service's."""
        if (checkpoint.service, checkpoint.session) != (self.service, self.session):
            raise ValueError(f"checkpoint of {checkpoint.service}/{checkpoint.session}, not of {self.service}")
        self.captured_ns = checkpoint.captured_ns
        self.epoch = max([self.epoch, *(place.epoch for place in checkpoint.outputs.values())])
        self.inputs = {Stream.parse(name): Position.of(place) for name, place in checkpoint.inputs.items()}
        self.outputs = {Stream.parse(name): Position.of(place) for name, place in checkpoint.outputs.items()}
        self.node.restore(checkpoint.state)

    def _place(self, stream: Stream, *, ended: bool) -> Position:
        last = self.outputs[stream]
        sequence = last.sequence + 1 if self.epoch == last.epoch else 0
        place = self.outputs[stream] = Position(self.epoch, sequence, ended)
        return place

    def _number(self, output: Output) -> Message:
        stream = self._streams[output.signal.name]
        place = self._place(stream, ended=False)
        return Message(stream, Envelope(place.epoch, place.sequence, output.captured_ns), output.payload)

    def _close(self, stream: Stream) -> Message:
        place = self._place(stream, ended=True)
        return Message(stream, Envelope(place.epoch, place.sequence, self.captured_ns, final=True), None)
