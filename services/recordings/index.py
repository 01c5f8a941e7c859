"""The index at the end of a closed MCAP file: where messages of a channel and time are, without reading the others.

What it says is checked where it is used: the index by its own checksum, each chunk by its, a message by its place.
"""

import io
import struct
import zlib
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import BinaryIO, NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.records import ChunkIndex

from services.recordings.chunks import BROKEN, ChannelFacts, RawMessage, open_chunk, parse_channel, parse_message
from services.recordings.errors import DamagedRecording
from services.recordings.frames import MAGIC, Opcode
from services.recordings.limits import LIMITS

_HEAD = struct.Struct("<BQ")
_FOOTER = struct.Struct("<QQI")
_INDEX_HEAD = struct.Struct("<HI")
_ENTRY = struct.Struct("<QQ")
_TAIL = _HEAD.size + _FOOTER.size + len(MAGIC)
_CHUNK_INDEX = 0x08
FILES_REMEMBERED = 256


class FileIndex(NamedTuple):
    """What a closed file says of itself."""

    path: Path
    channels: dict[int, ChannelFacts]
    chunks: tuple[ChunkIndex, ...]


class Place(NamedTuple):
    """Where one message is."""

    log_time: int
    path: Path
    chunk: int
    """Offset of its chunk's record in the file."""
    offset: int
    """Of its record in the chunk."""
    channel: int


def read_index(path: Path) -> FileIndex:
    """The index of a closed file. It is remembered until the file changes. Raises DamagedRecording, OSError."""
    stat = path.stat()
    return _read_index(path, stat.st_size, stat.st_mtime_ns)


@lru_cache(maxsize=FILES_REMEMBERED)
def _read_index(path: Path, size: int, _changed_ns: int) -> FileIndex:
    with path.open("rb") as file:
        try:
            return _parsed(path, _summary(file, size))
        except BROKEN as error:
            raise DamagedRecording(path, f"its index cannot be read ({error})") from error


def _summary(file: BinaryIO, size: int) -> bytes:
    """The bytes of the summary section. Raises one of BROKEN."""
    if size < _TAIL:
        raise ValueError("it is too short")
    file.seek(size - _TAIL)
    tail = file.read(_TAIL)
    opcode, length = _HEAD.unpack_from(tail)
    start, _, checksum = _FOOTER.unpack_from(tail, _HEAD.size)
    most = LIMITS.record_bytes
    if (opcode, length) != (Opcode.FOOTER, _FOOTER.size) or not tail.endswith(MAGIC):
        raise ValueError("it does not end like a closed file")
    if not 0 < start <= size - _TAIL or size - start > most:
        raise ValueError("its footer points outside of the file")
    file.seek(start)
    summary = file.read(size - _TAIL - start)
    if zlib.crc32(tail[: _HEAD.size + 16], zlib.crc32(summary)) != checksum:
        raise ValueError("the checksum of the index is wrong")
    return summary


def _parsed(path: Path, summary: bytes) -> FileIndex:
    channels: dict[int, ChannelFacts] = {}
    chunks: list[ChunkIndex] = []
    start = 0
    while start < len(summary):
        opcode, length = _HEAD.unpack_from(summary, start)
        body = summary[start + _HEAD.size : start + _HEAD.size + length]
        start += _HEAD.size + length
        if opcode == Opcode.CHANNEL:
            number, facts = parse_channel(body)
            channels[number] = facts
        elif opcode == _CHUNK_INDEX:
            chunks.append(ChunkIndex.read(ReadDataStream(io.BytesIO(body))))
    return FileIndex(path, channels, tuple(chunks))


def places(index: FileIndex, topics: frozenset[str], from_log: int, to_log: int) -> Iterator[Place]:
    """Where messages of some topics with from <= log time < to are, in the order of the file.

    Raises DamagedRecording, OSError.
    """
    wanted = {number for number, facts in index.channels.items() if facts.topic in topics}
    in_time = [
        each
        for each in index.chunks
        if each.message_start_time < to_log and each.message_end_time >= from_log
        and not wanted.isdisjoint(each.message_index_offsets)
    ]  # fmt: skip
    if not in_time:
        return
    with index.path.open("rb") as file:
        for chunk in in_time:
            found = []
            for number in wanted & chunk.message_index_offsets.keys():
                for log_time, offset in _entries(index.path, file, number, chunk.message_index_offsets[number]):
                    if from_log <= log_time < to_log:
                        found.append(Place(log_time, index.path, chunk.chunk_start_offset, offset, number))
            yield from sorted(found, key=lambda place: place.offset)


def _entries(path: Path, file: BinaryIO, channel: int, at: int) -> Iterator[tuple[int, int]]:
    """Log time and offset of each message of a channel in one chunk."""
    file.seek(at)
    try:
        opcode, length = _HEAD.unpack(file.read(_HEAD.size))
        if opcode != Opcode.MESSAGE_INDEX or length > LIMITS.record_bytes:
            raise ValueError("no message index is where the chunk index says")
        body = file.read(length)
        number, size = _INDEX_HEAD.unpack_from(body)
        if number != channel or size != length - _INDEX_HEAD.size:
            raise ValueError("a message index is not that of its channel")
        return _ENTRY.iter_unpack(body[_INDEX_HEAD.size :])
    except BROKEN as error:
        raise DamagedRecording(path, f"its index cannot be read ({error})") from error


def read_places(index: FileIndex, wanted: list[Place]) -> Iterator[RawMessage]:
    """The messages at some places of one file, in that order; a chunk is opened once for places that follow each other.

    Raises DamagedRecording, OSError.
    """
    with index.path.open("rb") as file:
        opened, data = -1, b""
        for place in wanted:
            try:
                if place.chunk != opened:
                    data, opened = _chunk(file, place.chunk), place.chunk
                yield _message(index, place, data)
            except BROKEN as error:
                raise DamagedRecording(index.path, f"a part of it has been altered ({error})") from error


def _chunk(file: BinaryIO, at: int) -> bytes:
    file.seek(at)
    opcode, length = _HEAD.unpack(file.read(_HEAD.size))
    if opcode != Opcode.CHUNK or length > LIMITS.record_bytes:
        raise ValueError("no chunk is where the index says")
    return open_chunk(file.read(length))


def _message(index: FileIndex, place: Place, data: bytes) -> RawMessage:
    opcode, length = _HEAD.unpack_from(data, place.offset)
    start = place.offset + _HEAD.size
    if opcode != Opcode.MESSAGE or start + length > len(data):
        raise ValueError("no message is where the index says")
    message = parse_message(data[start : start + length], index.channels)
    if message.log_time != place.log_time or message.channel != index.channels[place.channel]:
        raise ValueError("a message is not the one that the index names")
    return message
