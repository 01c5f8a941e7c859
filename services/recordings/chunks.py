"""The inner layer of an MCAP file: a chunk's bytes, checked, and the messages in it."""

import io
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, NamedTuple

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.records import Channel, Chunk

from schemas.archive_layout import END_TOPIC, EPOCH_KEY, SCHEMA_VERSION_KEY, StreamEnd
from services.recordings.frames import Opcode, corrupt
from services.recordings.limits import LIMITS, ReadLimits

BROKEN = (McapError, ValueError, struct.error, EOFError, KeyError, OverflowError, zstandard.ZstdError)
"""Whatever parsers raise on bytes that are not what they should be."""

_HEAD = struct.Struct("<BQ")
MESSAGE_HEAD = struct.Struct("<HIQQ")
"""channel, sequence, log time, publish time; the payload follows."""
_CHUNK_FIXED = 8 + 8 + 8 + 4 + 4 + 8
_INNER = frozenset({Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE})


class ChannelFacts(NamedTuple):
    """A channel of a file: one epoch of one stream."""

    topic: str
    epoch: int
    schema_version: str


class RawMessage(NamedTuple):
    """A message record as it stands in a chunk."""

    channel: ChannelFacts
    sequence: int
    log_time: int
    publish_time: int
    data: bytes

    @property
    def clock(self) -> str:
        """Name of what it must not overtake: its stream, also for the end of one. Raises ValueError."""
        if self.channel.topic == END_TOPIC:
            return StreamEnd.model_validate_json(self.data).stream
        return self.channel.topic


class ChunkSpan(NamedTuple):
    """Where a chunk's body lies, and from when it must be read to give messages out in time order.

    `clocks` holds, for each stream in the chunk, the newest log time before it: within a stream the order of
    sequence numbers wins over times that go back.
    """

    path: Path
    offset: int
    length: int
    from_ns: int
    clocks: dict[str, int]
    channels: dict[int, ChannelFacts]


def open_chunk(body: bytes, limits: ReadLimits = LIMITS) -> bytes:
    """The bytes inside a chunk record, checked against their checksum. Raises one of BROKEN."""
    chunk = Chunk.read(ReadDataStream(io.BytesIO(body)))
    if len(body) != _CHUNK_FIXED + len(chunk.compression.encode()) + len(chunk.data):
        raise ValueError("a chunk's length does not fit its contents")
    if chunk.compression != "zstd" or chunk.uncompressed_size > limits.chunk_bytes:
        raise ValueError(f"a chunk of {chunk.uncompressed_size} bytes, compressed by {chunk.compression!r}")
    # The size that the compressed bytes announce is what the decompressor would allocate.
    if zstandard.frame_content_size(chunk.data) != chunk.uncompressed_size:
        raise ValueError("a chunk's size does not fit its contents")
    data = zstandard.decompress(chunk.data, max_output_size=chunk.uncompressed_size)
    if zlib.crc32(data) != chunk.uncompressed_crc:
        raise ValueError("the checksum of a chunk is wrong")
    return data


def inner_records(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Kind and body of each record in a chunk. Raises one of BROKEN."""
    start = 0
    while start < len(data):
        opcode, length = _HEAD.unpack_from(data, start)
        start += _HEAD.size
        if opcode not in _INNER or length > len(data) - start:
            raise ValueError(f"record kind {opcode:#04x} of {length} bytes does not belong in a chunk")
        yield opcode, data[start : start + length]
        start += length


def parse_channel(body: bytes) -> tuple[int, ChannelFacts]:
    """Number and facts of a channel record. Raises one of BROKEN."""
    channel = Channel.read(ReadDataStream(io.BytesIO(body)))
    facts = ChannelFacts(channel.topic, int(channel.metadata[EPOCH_KEY]), channel.metadata[SCHEMA_VERSION_KEY])
    return channel.id, facts


def parse_message(body: bytes, channels: dict[int, ChannelFacts]) -> RawMessage:
    """A message record. Raises one of BROKEN, KeyError for a channel that was not announced."""
    channel, sequence, log_time, publish_time = MESSAGE_HEAD.unpack_from(body)
    return RawMessage(channels[channel], sequence, log_time, publish_time, body[MESSAGE_HEAD.size :])


def read_messages(file: BinaryIO, span: ChunkSpan) -> list[RawMessage]:
    """The messages of a chunk that a scan has found right. Raises Damage when the file has changed since."""
    file.seek(span.offset)
    try:
        records = inner_records(open_chunk(file.read(span.length)))
        return [parse_message(body, span.channels) for opcode, body in records if opcode == Opcode.MESSAGE]
    except BROKEN as error:
        raise corrupt(span.offset, f"the file has changed while it was read: {error}") from error
