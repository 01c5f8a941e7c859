"""The outer layer of an MCAP file, read strictly: records of known kinds, bounded in length, checksummed.

Only what our own files contain is accepted. A skipped unknown record would be a hole that nobody notices, so
anything unexpected is damage. The library's readers are more forgiving; they are for other people's files.
"""

import struct
import zlib
from collections.abc import Iterator
from enum import IntEnum
from typing import BinaryIO, NamedTuple

from services.recordings.errors import Damage, DamageKind
from services.recordings.limits import LIMITS, ReadLimits

MAGIC = b"\x89MCAP0\r\n"
_HEAD = struct.Struct("<BQ")
_FOOTER = struct.Struct("<QQI")


class Opcode(IntEnum):
    """The record kinds in the data section of our files, and the footer."""

    HEADER = 0x01
    FOOTER = 0x02
    SCHEMA = 0x03
    CHANNEL = 0x04
    MESSAGE = 0x05
    CHUNK = 0x06
    MESSAGE_INDEX = 0x07
    METADATA = 0x0C
    DATA_END = 0x0F


OUTER = frozenset({Opcode.HEADER, Opcode.CHUNK, Opcode.MESSAGE_INDEX, Opcode.METADATA, Opcode.DATA_END})


class Frame(NamedTuple):
    """One record of the data section. `offset` is where its body starts in the file."""

    opcode: int
    offset: int
    body: bytes


def corrupt(offset: int, reason: str) -> Damage:
    """Bytes that are there and wrong."""
    return Damage(DamageKind.CORRUPT, offset, reason)


def truncated(offset: int, reason: str) -> Damage:
    """Bytes that are not there."""
    return Damage(DamageKind.TRUNCATED, offset, reason)


def read_frames(file: BinaryIO, limits: ReadLimits = LIMITS) -> Iterator[Frame]:
    """The records of the data section, DATA_END included, whose checksums are then found to hold.

    Returns at the end of a file that stops between two records. Raises Damage anywhere else.
    """
    size = file.seek(0, 2)
    file.seek(0)
    magic = file.read(len(MAGIC))
    if magic != MAGIC:
        raise (truncated if MAGIC.startswith(magic) else corrupt)(0, "does not begin like an MCAP file")
    checksum = zlib.crc32(magic)
    while file.tell() < size:
        offset = file.tell()
        head, body = _read_record(file, size, limits)
        opcode = head[0]
        if opcode not in OUTER or (opcode == Opcode.HEADER) != (offset == len(MAGIC)):
            raise corrupt(offset, f"record kind {opcode:#04x} does not belong here")
        yield Frame(opcode, offset + _HEAD.size, body)
        if opcode == Opcode.DATA_END:
            _check_ending(file, size, body, checksum)
            return
        checksum = zlib.crc32(body, zlib.crc32(head, checksum))


def _read_record(file: BinaryIO, size: int, limits: ReadLimits) -> tuple[bytes, bytes]:
    offset = file.tell()
    head = file.read(_HEAD.size)
    if len(head) < _HEAD.size:
        raise truncated(offset, "ends within the head of a record")
    length = _HEAD.unpack(head)[1]
    if length > size - file.tell():
        raise truncated(offset, f"a record of {length} bytes is not complete")
    if length > limits.record_bytes:
        raise corrupt(offset, f"a record of {length} bytes is larger than {limits.record_bytes}")
    return head, file.read(length)


def _check_ending(file: BinaryIO, size: int, data_end: bytes, checksum: int) -> None:
    """The data section's checksum, the summary's checksum, and the closing magic."""
    offset = file.tell()
    if data_end != struct.pack("<I", checksum):
        raise corrupt(offset, "the checksum of the data section is wrong")
    tail_size = _HEAD.size + _FOOTER.size + len(MAGIC)
    if size - offset < tail_size:
        raise truncated(offset, "the index is not complete")
    summary = zlib.crc32(b"")
    for _ in range(offset, size - tail_size, 1 << 20):
        summary = zlib.crc32(file.read(min(1 << 20, size - tail_size - file.tell())), summary)
    tail = file.read(tail_size)
    opcode, length = _HEAD.unpack_from(tail)
    crc = _FOOTER.unpack_from(tail, _HEAD.size)[2]
    if (opcode, length) != (Opcode.FOOTER, _FOOTER.size) or not tail.endswith(MAGIC):
        raise truncated(offset, "the index is not complete")
    if crc != zlib.crc32(tail[: _HEAD.size + 16], summary):
        raise corrupt(offset, "the checksum of the index is wrong")
