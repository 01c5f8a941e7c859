"""A recorded session as a source: the raw samples of Ambula's own MCAP files, at the times they were captured.

The archive repairs and verifies; this driver only replays, so it takes what it can read and says what it could not.
"""

import heapq
import json
import re
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from operator import attrgetter
from pathlib import Path
from typing import NamedTuple

from mcap.exceptions import McapError
from mcap.records import Channel, Chunk, McapRecord, Message, Metadata
from mcap.stream_reader import StreamReader, breakup_chunk
from pydantic import ValidationError

from schemas.archive_layout import (
    DESCRIPTION_FIELD,
    EPOCH_KEY,
    SESSION_METADATA,
    SESSION_TOPIC,
    captured_ns,
    parse_file_name,
)
from schemas.health import Reason, Rejection
from schemas.imu import ImuBatch, ReferenceBatch
from schemas.payload import Payload
from schemas.session import SessionDescription
from schemas.signals import IMU, REFERENCE, SKELETON
from schemas.skeleton import SkeletonBatch
from services.flow.message import DecodeError, Envelope, Stream, decode_payload
from services.flow.raw_streams import raw_streams
from services.flow.rejections import RejectionCounter
from services.ingest.driver import SourceMessage
from services.ingest.errors import EmptyFile, MissingFile, UnreadableFile, place
from services.ingest.identity import Identity

MOST_RECORD_BYTES = 64 * 1024 * 1024
"""A single record or unpacked chunk beyond it is damage, or meant to exhaust the memory."""

MOST_FILE_BYTES = 4 * 1024 * 1024 * 1024
"""The raw samples are held in memory; longer sessions lie in several files."""

_RAW_TOPICS = tuple(f"{signal.name}/" for signal in (IMU, SKELETON, REFERENCE))

_SOURCE_NAME = re.compile(r"[A-Za-z0-9_-]{1,64}")

_BROKEN = (McapError, ValueError, EOFError, struct.error, KeyError, OverflowError, zlib.error, MemoryError)
"""Whatever the parser raises on bytes that are not what they should be."""


class _Stored(NamedTuple):
    """A raw message as the file holds it."""

    log_time: int
    epoch: int
    sequence: int
    data: bytes


@dataclass
class _Contents:
    """What could be read of a session's raw files."""

    description: SessionDescription | None = None
    stored: dict[str, dict[tuple[int, int], _Stored]] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)


def raw_files(folder: Path) -> list[Path]:
    """The raw files of a session folder, oldest first; those still open or left behind included."""
    named = [(parse_file_name(path.name), path) for path in folder.iterdir()]
    raw = [(name, path) for name, path in named if name is not None and name.kind == "raw"]
    return [path for _, path in sorted(raw, key=lambda entry: (entry[0].number, entry[0].part))]


class McapRecording:
    """The raw streams of one archived session."""

    def __init__(self, paths: list[Path], identity: Identity) -> None:
        """Read all files. Raises UnreadableFile, MissingFile or EmptyFile when there is nothing to replay."""
        self._identity = identity
        self._rejected = RejectionCounter()
        self._undelivered = RejectionCounter()
        self._contents = _Contents()
        for path in paths:
            self._read(path)
        found = self._contents.description
        if found is None:
            raise UnreadableFile(f"{place(paths[0])}: no session of Ambula in it; give the raw file of a recording")
        names = [hub.name for hub in found.hubs] + [camera.name for camera in found.cameras]
        if not all(_SOURCE_NAME.fullmatch(name) for name in names):
            raise UnreadableFile(
                f"{place(paths[0])}: a hub's or camera's name cannot stand in a key; this file was altered"
            )
        self._recorded = found
        if not any(self._contents.stored.get(stream.name) for stream in raw_streams(found)):
            raise EmptyFile(f"{place(paths[0])}: no samples in it; give the raw file of the recording")

    def describe(self) -> SessionDescription:
        """The recorded session under its new id, with what the operator chose."""
        renamed = self._recorded.model_copy(update={"session": self._identity.session, "origin": "archive"})
        return self._identity.choices.applied(renamed)

    def messages(self) -> Iterator[SourceMessage]:
        """As recorded: each stream by sequence number, the streams among each other by time of capture."""
        self._undelivered = RejectionCounter()
        streams = [self._replay(stream) for stream in raw_streams(self._recorded)]
        return heapq.merge(*streams, key=attrgetter("captured_ns"))

    def rejections(self) -> list[Rejection]:
        """Damaged files (each counts once) and messages that are not what their topic promises."""
        return self._rejected.report() + self._undelivered.report()

    def _replay(self, stream: Stream) -> Iterator[SourceMessage]:
        stored = self._contents.stored.get(stream.name, {})
        for _, message in sorted(stored.items()):
            time_ns = captured_ns(self._recorded, message.log_time)
            envelope = Envelope(message.epoch, message.sequence, time_ns)
            try:
                payload = decode_payload(stream.signal, envelope, message.data)
            except DecodeError:
                self._undelivered.add(stream.name, Reason.UNDECODABLE)
                continue
            assert payload is not None, "only final envelopes have no payload"
            if self._fits(stream, payload):
                yield SourceMessage(stream, time_ns, payload)
            else:
                self._undelivered.add(stream.name, Reason.WRONG_SHAPE)

    def _fits(self, stream: Stream, payload: Payload) -> bool:
        """Sensors of a hub, joints of a frame and channels of truth are as many as the description says."""
        match payload:
            case ImuBatch():
                hub = next(hub for hub in self._recorded.hubs if hub.name == stream.source)
                return len(payload.sensors) == len(hub.sensors)
            case SkeletonBatch():
                camera = next(camera for camera in self._recorded.cameras if camera.name == stream.source)
                width = len(camera.joints)
                return all(
                    len(position) == len(state) == width
                    for position, state in zip(payload.position, payload.state, strict=True)
                )
            case ReferenceBatch():
                width = len(self._recorded.reference)
                rows = payload.values
                return len(rows) == len(payload.captured_ns) and all(len(row) == width for row in rows)
        return False

    def _read(self, path: Path) -> None:
        self._contents.channels = {}
        try:
            if path.stat().st_size > MOST_FILE_BYTES:
                raise UnreadableFile(f"{place(path)}: larger than {MOST_FILE_BYTES} bytes; no recording is")
            with path.open("rb") as file:
                reader = StreamReader(file, emit_chunks=True, validate_crcs=True, record_size_limit=MOST_RECORD_BYTES)
                for record in reader.records:
                    self._take(record)
        except FileNotFoundError as error:
            raise MissingFile(f"no file {path}") from error
        except OSError as error:
            raise UnreadableFile(f"{place(path)}: {error}") from error
        except UnreadableFile:
            raise
        except _BROKEN:
            # What was taken so far stands: the samples before the damage carry their own checksums.
            self._rejected.add(path.name, Reason.UNDECODABLE)

    def _take(self, record: McapRecord) -> None:
        match record:
            case Chunk():
                if record.uncompressed_size > MOST_RECORD_BYTES:
                    raise ValueError("a chunk unpacks to more than it may")
                for inner in breakup_chunk(record, validate_crc=True):
                    self._take(inner)
            case Metadata() if record.name == SESSION_METADATA:
                self._describe(record.metadata[DESCRIPTION_FIELD])
            case Channel():
                self._contents.channels[record.id] = record
            case Message():
                self._store(record)

    def _store(self, record: Message) -> None:
        channel = self._contents.channels[record.channel_id]
        if channel.topic == SESSION_TOPIC:
            self._describe(record.data.decode())
            return
        if not channel.topic.startswith(_RAW_TOPICS) or not record.data:
            return
        epoch = int(channel.metadata[EPOCH_KEY])
        kept = self._contents.stored.setdefault(channel.topic, {})
        kept.setdefault((epoch, record.sequence), _Stored(record.log_time, epoch, record.sequence, record.data))

    def _describe(self, text: str) -> None:
        """The first description stands: all files of a session carry the same."""
        if self._contents.description is None:
            try:
                self._contents.description = SessionDescription.model_validate(json.loads(text))
            except ValidationError as error:
                raise ValueError("the session description is not one") from error
