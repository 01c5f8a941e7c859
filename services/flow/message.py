"""A message between nodes: the payload with its envelope, and the envelope's wire form."""

import re
from dataclasses import dataclass
from typing import NamedTuple

from schemas.payload import SCHEMA_VERSION, Payload
from schemas.signals import BY_NAME, Signal


class Stream(NamedTuple):
    """One ordered stream of a session."""

    signal: Signal
    source: str

    @property
    def name(self) -> str:
        """`signal/source`, as in health, gaps and checkpoints."""
        return f"{self.signal.name}/{self.source}"

    @classmethod
    def parse(cls, name: str) -> "Stream":
        """Inverse of `name`. Raises KeyError for a signal that the table does not have."""
        signal, _, source = name.partition("/")
        return cls(BY_NAME[signal], source)


_COUNT = rb"(0|[1-9][0-9]{0,18})"
_ENVELOPE = re.compile(_COUNT + b" " + _COUNT + rb" (0|-?[1-9][0-9]{0,18}) ([01]) ([0-9A-Za-z.-]{1,32})")
"""One spelling for each envelope, so that equal envelopes are equal bytes; numbers of at most 64 bits or so."""


class DecodeError(ValueError):
    """Bytes that are not what their key promises."""


@dataclass(frozen=True, slots=True)
class Envelope:
    """What travels beside a payload.

    `epoch` is the producer's incarnation; within it `sequence` counts 0, 1, 2, ... without holes.
    `final` marks the end of the stream: the message has an empty payload and takes the next sequence number.
    """

    epoch: int
    sequence: int
    captured_ns: int
    final: bool = False
    schema_version: str = SCHEMA_VERSION

    def encode(self) -> bytes:
        """Five words of ASCII, readable by any Zenoh tool."""
        final = int(self.final)
        return f"{self.epoch} {self.sequence} {self.captured_ns} {final} {self.schema_version}".encode()

    @classmethod
    def decode(cls, data: bytes) -> "Envelope":
        """Raises DecodeError when the bytes are no envelope."""
        words = _ENVELOPE.fullmatch(data)
        if words is None:
            raise DecodeError(f"not an envelope: {data[:64]!r}")
        epoch, sequence, captured_ns, final, version = words.groups()
        return cls(int(epoch), int(sequence), int(captured_ns), final == b"1", version.decode("ascii"))


@dataclass(frozen=True, slots=True)
class Message:
    """A decoded message of a stream. `payload` is None exactly when the envelope is final."""

    stream: Stream
    envelope: Envelope
    payload: Payload | None


@dataclass(frozen=True, slots=True)
class Output:
    """What a node hands back; the host gives it an envelope."""

    signal: Signal
    captured_ns: int
    payload: Payload


def encode_payload(payload: Payload | None) -> bytes:
    """JSON text; empty for the end of a stream."""
    return b"" if payload is None else payload.model_dump_json().encode()


def decode_payload(signal: Signal, envelope: Envelope, data: bytes) -> Payload | None:
    """Raises DecodeError when the bytes are not a payload of that signal."""
    if envelope.final:
        return None
    try:
        return signal.model.model_validate_json(data)
    except ValueError as error:
        raise DecodeError(f"not a {signal.name} payload: {data[:80]!r}") from error
