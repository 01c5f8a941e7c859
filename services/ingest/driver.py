"""The face of every driver: it says what it will deliver, then delivers it in order, then says what it left out."""

from collections.abc import Iterator
from typing import NamedTuple, Protocol

from schemas.health import Rejection
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
