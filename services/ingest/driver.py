"""The face of every driver: it says what it will deliver, then delivers it in order, then says what it left out."""

from collections.abc import Iterator
from typing import NamedTuple, Protocol, runtime_checkable

from schemas.health import Rejection, StreamCount
from schemas.payload import Payload
from schemas.session import SessionDescription
from services.flow.message import Stream


class SourceMessage(NamedTuple):
    """One message before it has a number."""

    stream: Stream
    captured_ns: int
    payload: Payload


class Source(Protocol):
    """One session's worth of samples, from wherever they come."""

    def describe(self) -> SessionDescription:
        """The session, known before the first sample is asked for."""

    def messages(self) -> Iterator[SourceMessage]:
        """Every message, one hub tick each, in the order of capture; each call starts anew.

        Raises SourceError when the source turns out to be unusable on the way.
        """

    def rejections(self) -> list[Rejection]:
        """What was left out so far, by subject and reason."""


class Feed(Protocol):
    """Messages on their way into a running session, for one thread; never waits."""

    @property
    def is_empty(self) -> bool:
        """Everything was taken, and there will be no more."""

    def peek(self) -> SourceMessage | None:
        """The next message, if it is there already. Raises what the source raises."""

    def pop(self) -> SourceMessage:
        """Take the message that `peek` showed."""

    def close(self) -> None:
        """No more is wanted. May be called twice."""


@runtime_checkable
class LiveSource(Source, Feed, Protocol):
    """A device: messages come when they come, from the moment it is opened until it is closed."""

    def counts(self) -> list[StreamCount]:
        """What came over the device's own link, and what was lost there."""

    def stop(self) -> None:
        """Take no more; what came stays to be taken. From any thread."""
