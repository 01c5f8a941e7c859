"""Close a recording's file: rewrite what was appended with large chunks, an index and checksums.

The closed file gets its name only when all of it is on the disk; until then the `.part` file stays. The same code
closes a file in order and recovers the file of a process that was killed.
"""

import hashlib
import io
from pathlib import Path
from typing import Any, BinaryIO

from mcap.data_stream import ReadDataStream
from mcap.records import Channel, Schema
from mcap.writer import CompressionType, Writer

from schemas.archive_layout import DAMAGED_SUFFIX, PART_SUFFIX, PROFILE, SegmentEntry
from services.archive.disk import Disk
from services.recordings.chunks import MESSAGE_HEAD, inner_records, open_chunk
from services.recordings.errors import DamageKind
from services.recordings.frames import Opcode
from services.recordings.segment import SegmentScan, scan

SEALING_SUFFIX = ".sealing"
_WRITE_BUFFER = 1 << 20


class _HashedFile(io.RawIOBase):
    """Hashes what it writes. The Disk does the writing, so that its failures can be tested."""

    def __init__(self, disk: Disk, path: Path) -> None:
        super().__init__()
        self._disk = disk
        self.descriptor = disk.create(path)
        self.sha256 = hashlib.sha256()
        self.size = 0

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        piece = bytes(data)
        self._disk.write(self.descriptor, piece)
        self.sha256.update(piece)
        self.size += len(piece)
        return len(piece)

    def tell(self) -> int:
        return self.size


def seal(part: Path, software: str, disk: Disk, chunk_bytes: int) -> SegmentEntry | None:
    """Turn `x.mcap.part` into `x.mcap`; None when nothing in it could be used.

    A file that was cut short loses its incomplete end. One whose bytes have been altered is kept besides, as
    `.damaged`. Raises OSError when the disk fails: the `.part` file is then still there.
    """
    target = part.with_name(part.name.removesuffix(PART_SUFFIX))
    found = scan(part)
    entry = _rewrite(found, target, software, disk, chunk_bytes) if found.messages else None
    if found.damage is not None and found.damage.kind is DamageKind.CORRUPT:
        disk.replace(part, part.with_name(part.name + DAMAGED_SUFFIX))
    else:
        disk.remove(part)
    disk.sync_folder(part.parent)
    return entry


def entry_of(found: SegmentScan, sha256: str, size_bytes: int) -> SegmentEntry:
    """What the manifest says about a file."""
    damage = found.damage
    return SegmentEntry(
        name=found.path.name.removesuffix(PART_SUFFIX),
        size_bytes=size_bytes,
        sha256=sha256,
        messages=found.messages,
        streams=found.ledger.spans(),
        damage=str(damage) if damage is not None and damage.kind is DamageKind.CORRUPT else None,
    )


def _rewrite(found: SegmentScan, target: Path, software: str, disk: Disk, chunk_bytes: int) -> SegmentEntry:
    draft = target.with_name(target.name + SEALING_SUFFIX)
    disk.remove(draft)
    raw = _HashedFile(disk, draft)
    try:
        output = io.BufferedWriter(raw, _WRITE_BUFFER)
        _copy(found, output, software, chunk_bytes)
        output.flush()
        disk.sync(raw.descriptor)
    finally:
        disk.close(raw.descriptor)
    disk.replace(draft, target)
    disk.sync_folder(target.parent)
    return entry_of(found, raw.sha256.hexdigest(), raw.size)


def _copy(found: SegmentScan, output: BinaryIO, software: str, chunk_bytes: int) -> None:
    writer = Writer(output, chunk_bytes, CompressionType.ZSTD, enable_crcs=True, enable_data_crcs=True)
    writer.start(PROFILE, software)
    for metadata in found.metadata:
        writer.add_metadata(metadata.name, metadata.metadata)
    copy = _RecordCopy(writer)
    with found.path.open("rb") as source:
        for span in found.chunks:
            source.seek(span.offset)
            for opcode, body in inner_records(open_chunk(source.read(span.length))):
                copy.take(opcode, body)
    writer.finish()


class _RecordCopy:
    """Hands the records of a journal to a writer, which numbers schemas and channels anew."""

    def __init__(self, writer: Writer) -> None:
        self._writer = writer
        self._schemas = {0: 0}
        self._channels: dict[int, int] = {}

    def take(self, opcode: int, body: bytes) -> None:
        """One record out of a chunk."""
        stream = ReadDataStream(io.BytesIO(body))
        if opcode == Opcode.SCHEMA:
            schema = Schema.read(stream)
            self._schemas[schema.id] = self._writer.register_schema(schema.name, schema.encoding, schema.data)
        elif opcode == Opcode.CHANNEL:
            channel = Channel.read(stream)
            if channel.id not in self._channels:
                self._channels[channel.id] = self._writer.register_channel(
                    channel.topic, channel.message_encoding, self._schemas[channel.schema_id], channel.metadata
                )
        else:
            number, sequence, log_time, publish_time = MESSAGE_HEAD.unpack_from(body)
            data = body[MESSAGE_HEAD.size :]
            self._writer.add_message(self._channels[number], log_time, data, publish_time, sequence)
