"""A recorded session as a source: the raw samples of Ambula's own MCAP files, at the times they were captured.

The archive repairs and verifies; this driver only replays, so it takes what it can read and says what it could not.
"""

import heapq
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from operator import attrgetter
from pathlib import Path
from typing import NamedTuple

from schemas.archive_layout import captured_ns
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
from services.recordings.chunks import RawMessage, read_messages
from services.recordings.errors import Damage
from services.recordings.folder import segment_files
from services.recordings.segment import SegmentScan, scan

MOST_FILE_BYTES = 4 * 1024 * 1024 * 1024
"""The raw samples are held in memory; longer sessions lie in several files."""

_RAW_TOPICS = tuple(f"{signal.name}/" for signal in (IMU, SKELETON, REFERENCE))

_SOURCE_NAME = re.compile(r"[A-Za-z0-9_-]{1,64}")


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


def raw_files(folder: Path) -> list[Path]:
    """The raw files of a session folder, oldest first; those still open or left behind included."""
    return [path for name, path in segment_files(folder) if name.kind == "raw"]


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
        try:
            if path.stat().st_size > MOST_FILE_BYTES:
                raise UnreadableFile(f"{place(path)}: larger than {MOST_FILE_BYTES} bytes; no recording is")
            whole = self._take(scan(path))
        except FileNotFoundError as error:
            raise MissingFile(f"no file {path}") from error
        except OSError as error:
            raise UnreadableFile(f"{place(path)}: {error}") from error
        except Damage:
            whole = False
        if not whole:
            # What was taken so far stands: the samples before the damage carry their own checksums.
            self._rejected.add(path.name, Reason.UNDECODABLE)

    def _take(self, found: SegmentScan) -> bool:
        """What was found right in a file, and whether that is all of it. Raises Damage, OSError.

        The first description stands: all files of a session carry the same.
        """
        if self._contents.description is None:
            self._contents.description = found.description
        with found.path.open("rb") as file:
            for span in found.chunks:
                for message in read_messages(file, span):
                    self._store(message)
        return found.whole

    def _store(self, message: RawMessage) -> None:
        topic, epoch, _ = message.channel
        if topic.startswith(_RAW_TOPICS) and message.data:
            kept = self._contents.stored.setdefault(topic, {})
            stored = _Stored(message.log_time, epoch, message.sequence, message.data)
            kept.setdefault((epoch, message.sequence), stored)
