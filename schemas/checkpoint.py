"""The state of a node with its place in its streams: enough to go on elsewhere as if nothing had happened."""

from typing import Any

from pydantic import Field

from schemas.payload import Payload, SessionTime


class StreamPosition(Payload):
    """The last message of a stream that has been dealt with."""

    epoch: int = Field(description="producer's incarnation, dimensionless")
    sequence: int = Field(ge=-1, description="last sequence number done; -1 before the first")
    ended: bool = Field(description="the producer closed the stream after that message")


class Checkpoint(Payload):
    """One node of one session, frozen between two messages."""

    service: str
    session: str
    captured_ns: SessionTime
    inputs: dict[str, StreamPosition] = Field(description="signal/source -> position")
    outputs: dict[str, StreamPosition] = Field(description="signal/source -> last message produced")
    state: dict[str, Any] = Field(description="the node's own snapshot")
