"""Replay on the wire: a producer's ring asked by sequence number.

Question: `replay_key` with the parameters from, and optionally epoch, to, most. Answer: the messages in order, each
as it was sent, and at last one answer without attachment that carries the ring's extent.
"""

import threading
from collections.abc import Iterable, Mapping

from schemas.signals import Signal, replay_key
from services.bus.connection import Bus
from services.bus.received import Handle, Received
from services.flow.message import Stream
from services.flow.ring import Question, ReplayRing

PAGE = 256
"""Messages per answer: a burst that fits the queues on the way, as answers are dropped rather than waited for."""


def question_parameters(question: Question, most: int = PAGE) -> dict[str, str]:
    """The parameters of a question."""
    named = {"epoch": question.epoch, "from": question.first, "to": question.last, "most": most}
    return {name: str(value) for name, value in named.items() if value is not None}


def parse_question(parameters: Mapping[str, str]) -> tuple[Question, int]:
    """Question and most messages. Raises ValueError when a number is none."""

    def number(name: str) -> int | None:
        return int(parameters[name]) if name in parameters else None

    return Question(number("epoch"), number("from") or 0, number("to")), number("most") or PAGE


class SharedRing:
    """A replay ring that one thread fills while others answer from it."""

    def __init__(self, ring: ReplayRing) -> None:
        self.ring = ring
        self.lock = threading.Lock()


class RingServer:
    """Answers for all streams of one signal that this process produces: one queryable, one thread."""

    def __init__(self, bus: Bus, signal: Signal) -> None:
        self._rings: dict[str, SharedRing] = {}
        self._site = bus.settings.site
        self._handle = bus.serve(replay_key(self._site, "*", signal, "*"), self._answer)

    @classmethod
    def of(cls, bus: Bus, signal: Signal) -> "RingServer":
        """The one of this process for that signal."""
        servers = bus.extras.setdefault(cls.__name__, {})
        if signal.name not in servers:
            servers[signal.name] = cls(bus, signal)
        server = servers[signal.name]
        assert isinstance(server, cls)
        return server

    def add(self, session: str, stream: Stream, ring: SharedRing) -> Handle:
        """Answer for that stream until the handle is closed."""
        key = replay_key(self._site, session, stream.signal, stream.source)
        self._rings[key] = ring
        return Handle(lambda: self._remove(key))

    def _remove(self, key: str) -> None:
        self._rings.pop(key, None)

    def _answer(self, key: str, parameters: dict[str, str], _body: bytes) -> Iterable[Received]:
        shared = self._rings.get(key)
        if shared is None:
            return []
        question, most = parse_question(parameters)
        with shared.lock:
            messages = shared.ring.answer(question, most)
            extent = shared.ring.extent()
        answers = [Received(key, envelope.encode(), payload) for envelope, payload in messages]
        if extent is not None:
            answers.append(Received(key, b"", extent.encode()))
        return answers
