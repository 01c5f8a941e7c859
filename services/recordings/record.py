"""A message as the archive sees it: bytes with an envelope, never decoded."""

from typing import NamedTuple

from services.flow.message import Envelope, Stream


class Record(NamedTuple):
    """One message of a stream; an empty payload closes the stream when the envelope is final."""

    stream: Stream
    envelope: Envelope
    payload: bytes
    received_unix_ns: int
