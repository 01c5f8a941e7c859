"""Messages of several streams in the order of captured time, whatever their order of arrival."""

from services.flow.message import Envelope, Message, Stream
from services.flow.node import State


class MessageMerge:
    """A message is passed on when every stream has come as far, or some stream is `lateness_ns` further.

    Only captured times decide, never arrival. What comes after its time has passed is passed on at once; whoever takes
    it counts it as late. Equal times are passed in the order of the streams.
    """

    def __init__(self, streams: tuple[Stream, ...], lateness_ns: int) -> None:
        self._streams = streams
        self._lateness_ns = lateness_ns
        self._reached_ns = [-1] * len(streams)
        self._waiting: list[tuple[int, int, int, Message]] = []
        self._count = 0

    def accept(self, message: Message) -> list[Message]:
        """Take a message; those whose time has come."""
        place, captured_ns = self._streams.index(message.stream), message.envelope.captured_ns
        self._reached_ns[place] = max(self._reached_ns[place], captured_ns)
        self._waiting.append((captured_ns, place, self._count, message))
        self._count += 1
        all_there, too_late = min(self._reached_ns), max(self._reached_ns) - self._lateness_ns
        return self._pass_on(max(all_there, too_late))

    def finish(self) -> list[Message]:
        """No more messages: what still waits."""
        return self._pass_on(max(self._reached_ns))

    def _pass_on(self, until_ns: int) -> list[Message]:
        self._waiting.sort(key=lambda each: each[:3])
        ready = [message for captured_ns, _, _, message in self._waiting if captured_ns <= until_ns]
        del self._waiting[: len(ready)]
        return ready

    def snapshot(self) -> State:
        """What waits, and how far the streams are."""
        waiting = [
            [message.stream.name, message.envelope.encode().decode(), _dumped(message)]
            for _, _, _, message in self._waiting
        ]
        return {"reached_ns": list(self._reached_ns), "waiting": waiting}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._reached_ns, self._waiting, self._count = list(state["reached_ns"]), [], 0
        for name, envelope, payload in state["waiting"]:
            stream = Stream.parse(name)
            message = Message(stream, Envelope.decode(envelope.encode()), stream.signal.model.model_validate(payload))
            place = self._streams.index(stream)
            self._waiting.append((message.envelope.captured_ns, place, self._count, message))
            self._count += 1


def _dumped(message: Message) -> State:
    assert message.payload is not None
    return message.payload.model_dump(mode="json")
