"""Parts of a recorded session: messages of some signals and times, found by the files' indexes.

For pages that show a few seconds out of an hour. Whole sessions are read, and checked from end to end, by `reader`.
"""

import io
from collections.abc import Iterable, Iterator
from functools import lru_cache
from itertools import groupby
from operator import attrgetter
from pathlib import Path
from typing import NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.records import Metadata

from schemas.archive_layout import captured_ns, log_time_ns, parse_topic
from schemas.session import SessionDescription
from schemas.signals import Signal
from services.flow.message import Envelope, Stream
from services.recordings.chunks import BROKEN, RawMessage
from services.recordings.errors import ArchiveError, Damage, DamagedRecording, NotARecording
from services.recordings.folder import derived_versions, read_manifest, segment_files
from services.recordings.frames import Opcode, read_frames
from services.recordings.index import FileIndex, Place, places, read_index, read_places
from services.recordings.record import Record
from services.recordings.segment import description_in


class NotClosed(ArchiveError):
    """A file of the recording is still open: it is being written, or has to be recovered."""


class Found(NamedTuple):
    """A message that is there and has not been read."""

    captured_ns: int
    """ns of session time, as in its envelope."""
    stream: str
    place: Place


class RecordedRanges:
    """The closed files of one session: its raw ones and one version of derived ones."""

    def __init__(self, folder: Path, derived_version: str | None = None) -> None:
        """`derived_version` None: the one written live. Raises NotARecording, NotClosed, DamagedRecording, OSError."""
        version = derived_version or _live_version(folder)
        paths = [path for name, path in _closed(folder) if name is None or name == version]
        if not paths:
            raise NotARecording(f"{folder.name} holds no file of a recorded session")
        self._files: dict[Path, FileIndex] = {path: read_index(path) for path in paths}
        self.description: SessionDescription = _description(paths[0])

    @property
    def end_ns(self) -> int:
        """Time of the newest message of any signal, ns of session time."""
        newest = (chunk.message_end_time for index in self._files.values() for chunk in index.chunks)
        return captured_ns(self.description, max(newest, default=self.description.started_unix_ns))

    def find(self, signal: Signal, from_ns: int, to_ns: int) -> list[Found]:
        """Messages of a signal with from <= captured time < to, ns of session time, by that time.

        No message is read for it. Raises DamagedRecording, OSError.
        """
        started = self.description
        found = [
            Found(captured_ns(started, place.log_time), index.channels[place.channel].topic, place)
            for index in self._files.values()
            for place in places(
                index, _topics(index, signal), log_time_ns(started, from_ns), log_time_ns(started, to_ns)
            )
        ]
        return sorted(found, key=attrgetter("captured_ns"))

    def read(self, wanted: Iterable[Found]) -> Iterator[Record]:
        """Those messages, file by file and chunk by chunk: as many bytes are opened as must be.

        Raises DamagedRecording, OSError.
        """
        ordered = sorted((each.place for each in wanted), key=lambda place: (place.path, place.chunk, place.offset))
        for path, group in groupby(ordered, attrgetter("path")):
            for message in read_places(self._files[path], list(group)):
                yield _record(self.description, message)


def _closed(folder: Path) -> list[tuple[str | None, Path]]:
    """Version and path of every closed file. Raises NotClosed when one is open still."""
    files = segment_files(folder)
    closed = {name for name, _ in files if not name.part}
    if any(name.part and name.sealed not in closed for name, _ in files):
        raise NotClosed(f"{folder.name}: a file of the recording is still open")
    return [(name.version, path) for name, path in files if not name.part]


def _live_version(folder: Path) -> str | None:
    manifest = read_manifest(folder)
    return manifest.derived_version if manifest is not None else next(iter(derived_versions(folder)), None)


def _description(path: Path) -> SessionDescription:
    """Out of the head of a file, before its first chunk."""
    with path.open("rb") as file:
        try:
            for frame in read_frames(file):
                if frame.opcode == Opcode.CHUNK:
                    break
                metadata = _metadata(frame.body) if frame.opcode == Opcode.METADATA else None
                description = None if metadata is None else description_in(metadata)
                if description is not None:
                    return description
        except (*BROKEN, Damage) as error:
            raise DamagedRecording(path, str(error)) from error
    raise DamagedRecording(path, "it does not say whose session it is")


def _metadata(body: bytes) -> Metadata:
    return Metadata.read(ReadDataStream(io.BytesIO(body)))


def _topics(index: FileIndex, signal: Signal) -> frozenset[str]:
    found = set()
    for facts in index.channels.values():
        parsed = parse_topic(facts.topic)
        if parsed is not None and parsed[0] is signal:
            found.add(facts.topic)
    return frozenset(found)


def _record(description: SessionDescription, message: RawMessage) -> Record:
    channel, at_ns = message.channel, captured_ns(description, message.log_time)
    envelope = Envelope(channel.epoch, message.sequence, at_ns, schema_version=channel.schema_version)
    return Record(_stream(channel.topic), envelope, message.data, message.publish_time)


@lru_cache(maxsize=256)
def _stream(topic: str) -> Stream:
    """Asked for each message, and there are few. Raises KeyError for what `find` never finds."""
    return Stream.parse(topic)
