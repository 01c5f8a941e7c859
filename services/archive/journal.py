"""The file of a recording under way: MCAP that is only ever appended to, so that any prefix of it can be read.

It has no index and one small chunk per flush. When it is closed, `seal` rewrites it with large chunks and an index.
"""

import hashlib
import json
import struct
import zlib
from functools import cache
from pathlib import Path

import zstandard
from mcap.data_stream import RecordBuilder
from mcap.records import Channel, Chunk, Header, Metadata, Schema

from schemas.archive_layout import (
    DESCRIPTION_FIELD,
    DESCRIPTION_SHA256_KEY,
    END_TOPIC,
    MESSAGE_ENCODING,
    PROFILE,
    SCHEMA_ENCODING,
    SCHEMA_VERSION_KEY,
    SEGMENT_KEY,
    SESSION_KEY,
    SESSION_METADATA,
    SESSION_TOPIC,
    SOFTWARE_KEY,
    TIME_UNIT,
    TIME_UNIT_KEY,
    StreamEnd,
    channel_metadata,
    log_time_ns,
    topic,
)
from schemas.payload import SCHEMA_VERSION, Payload
from schemas.session import SessionDescription
from schemas.signals import GAP, SESSION, Signal
from services.archive.disk import Disk
from services.flow.message import Envelope
from services.recordings.frames import MAGIC, Opcode
from services.recordings.limits import MIB
from services.recordings.record import Record

_MESSAGE = struct.Struct("<BQHIQQ")
_FIXED = 2 + 4 + 8 + 8
"""A message record: kind and length, then `_FIXED` bytes of channel, sequence and the two times, then the payload."""
LOG_TIME_LIMIT = 1 << 64
SEQUENCE_LIMIT = 1 << 32
"""MCAP holds times in 64 and sequence numbers in 32 unsigned bits."""
LARGEST_PAYLOAD = 16 * MIB
"""bytes; an ordinary message has 1 kB."""


def session_metadata(description: SessionDescription, file_name: str, software: str) -> dict[str, str]:
    """The `ambula.session` record: makes a single file of a session complete in itself."""
    text = description.model_dump_json()
    return {
        SESSION_KEY: description.session,
        SCHEMA_VERSION_KEY: SCHEMA_VERSION,
        TIME_UNIT_KEY: TIME_UNIT,
        SEGMENT_KEY: file_name,
        SOFTWARE_KEY: software,
        DESCRIPTION_FIELD: text,
        DESCRIPTION_SHA256_KEY: hashlib.sha256(text.encode()).hexdigest(),
    }


@cache
def schema_text(model: type[Payload]) -> bytes:
    """JSON Schema of a model."""
    return json.dumps(model.model_json_schema(), sort_keys=True).encode()


class Journal:
    """Appends chunks to one `.part` file. After any OSError it must be closed and its file recovered."""

    def __init__(
        self, disk: Disk, path: Path, description: SessionDescription, software: str, chunk_bytes: int
    ) -> None:
        self.path = path
        self._disk = disk
        self._chunk_bytes = chunk_bytes
        self._description = description
        self._schemas: dict[str, int] = {}
        self._channels: dict[tuple[str, int, str], int] = {}
        self._builder = RecordBuilder()
        self._compressor = zstandard.ZstdCompressor()
        self._from_ns, self._to_ns, self._messages = LOG_TIME_LIMIT, 0, 0
        self._unsynced = False
        self._descriptor = disk.create(path)
        try:
            disk.sync_folder(path.parent)
            self._append(self._opening(software))
            self._describe()
        except OSError:
            self.close()
            raise

    def fits(self, record: Record) -> bool:
        """Whether MCAP, and a reader with our limits, can hold the message."""
        if len(record.payload) > LARGEST_PAYLOAD:
            return False
        time = log_time_ns(self._description, record.envelope.captured_ns)
        return 0 <= time < LOG_TIME_LIMIT and 0 <= record.envelope.sequence < SEQUENCE_LIMIT

    def add(self, record: Record) -> None:
        """Take a message of a stream; a final one becomes a `StreamEnd`."""
        envelope = record.envelope
        if envelope.final:
            self._add_end(record)
            return
        signal, source = record.stream
        name = topic(signal, source)
        channel = self._channel(name, signal.name, signal.model, envelope.epoch, envelope.schema_version)
        self._add(channel, self._times(envelope, record.received_unix_ns), record.payload)

    def add_own(self, signal: Signal, envelope: Envelope, payload: Payload, received_unix_ns: int) -> None:
        """Take a message that the archive itself has to say."""
        name = topic(signal, GAP.producer)
        channel = self._channel(name, signal.name, signal.model, envelope.epoch, envelope.schema_version)
        self._add(channel, self._times(envelope, received_unix_ns), payload.model_dump_json().encode())

    def push(self) -> None:
        """Hand what waits to the operating system, as one chunk: a kill cannot take it any more."""
        if self._messages:
            self._append(self._cut())

    @property
    def unsynced(self) -> bool:
        """Whether something was pushed that a power cut could take."""
        return self._unsynced

    def sync(self) -> None:
        """Wait until what was pushed is on the disk. May run beside `add` and `push`, not beside `close`."""
        self._unsynced = False
        self._disk.sync(self._descriptor)

    def close(self) -> None:
        """Give the descriptor back; what was not flushed is not in the file."""
        self._disk.close(self._descriptor)

    def _describe(self) -> None:
        started = log_time_ns(self._description, 0)
        channel = self._channel(SESSION_TOPIC, SESSION.name, SESSION.model, 0, SCHEMA_VERSION)
        self._add(channel, (0, started, started), self._description.model_dump_json().encode())

    def _opening(self, software: str) -> bytes:
        head = RecordBuilder()
        head.write(MAGIC)
        Header(PROFILE, software).write(head)
        metadata = session_metadata(self._description, self.path.name, software)
        Metadata(name=SESSION_METADATA, metadata=metadata).write(head)
        return bytes(head.end())

    def _append(self, data: bytes) -> None:
        """A write that fails may leave half a record behind, which recovery drops."""
        self._disk.write(self._descriptor, data)
        self._unsynced = True

    def _times(self, envelope: Envelope, received_unix_ns: int) -> tuple[int, int, int]:
        return envelope.sequence, log_time_ns(self._description, envelope.captured_ns), received_unix_ns

    def _add_end(self, record: Record) -> None:
        envelope = record.envelope
        end = StreamEnd(
            stream=record.stream.name,
            epoch=envelope.epoch,
            sequence=envelope.sequence,
            captured_ns=envelope.captured_ns,
        )
        channel = self._channel(END_TOPIC, "stream_end", StreamEnd, 0, SCHEMA_VERSION)
        self._add(channel, self._times(envelope, record.received_unix_ns), end.model_dump_json().encode())

    def _channel(self, name: str, schema: str, model: type[Payload], epoch: int, version: str) -> int:
        key = (name, epoch, version)
        if key not in self._channels:
            self._channels[key] = len(self._channels) + 1
            Channel(
                id=self._channels[key],
                topic=name,
                message_encoding=MESSAGE_ENCODING,
                schema_id=self._schema(schema, model),
                metadata=channel_metadata(self._description.session, epoch, version),
            ).write(self._builder)
        return self._channels[key]

    def _schema(self, name: str, model: type[Payload]) -> int:
        if name not in self._schemas:
            self._schemas[name] = len(self._schemas) + 1
            data = schema_text(model)
            Schema(id=self._schemas[name], name=name, encoding=SCHEMA_ENCODING, data=data).write(self._builder)
        return self._schemas[name]

    def _add(self, channel: int, numbers: tuple[int, int, int], data: bytes) -> None:
        sequence, log_time, received = numbers
        self._builder.write(_MESSAGE.pack(Opcode.MESSAGE, _FIXED + len(data), channel, sequence, log_time, received))
        self._builder.write(data)
        self._from_ns, self._to_ns = min(self._from_ns, log_time), max(self._to_ns, log_time)
        self._messages += 1
        if self._builder.count > self._chunk_bytes:
            self._append(self._cut())

    def _cut(self) -> bytes:
        data = self._builder.end()
        chunk = RecordBuilder()
        Chunk(
            compression="zstd",
            data=self._compressor.compress(data),
            message_start_time=self._from_ns,
            message_end_time=self._to_ns,
            uncompressed_crc=zlib.crc32(data),
            uncompressed_size=len(data),
        ).write(chunk)
        self._from_ns, self._to_ns, self._messages = LOG_TIME_LIMIT, 0, 0
        return bytes(chunk.end())
