"""Read a recorded session back: all its files as one run of messages in time order, or a typed error."""

import heapq
from collections.abc import Iterable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, NamedTuple

from schemas.archive_layout import (
    END_TOPIC,
    PART_SUFFIX,
    SegmentName,
    StreamEnd,
    captured_ns,
    parse_file_name,
    parse_topic,
)
from schemas.session import SessionDescription
from schemas.signals import GAP, Quality
from services.flow.message import Envelope, Message, Stream, decode_payload
from services.recordings.chunks import ChunkSpan, RawMessage, read_messages
from services.recordings.errors import ArchiveError, DamagedRecording, DamageKind, NotARecording
from services.recordings.folder import read_manifest, segment_files
from services.recordings.ledger import Ledger
from services.recordings.limits import LIMITS, ReadLimits
from services.recordings.record import Record
from services.recordings.segment import SegmentScan, scan


class _Waiting(NamedTuple):
    """A message that has been read but is not the next one yet."""

    log_time: int
    order: tuple[int, int]
    message: RawMessage


@dataclass
class Recording:
    """A session folder, scanned. `problem` is why it holds less than was recorded, or has been altered."""

    folder: Path
    description: SessionDescription
    chunks: list[ChunkSpan]
    ledger: Ledger
    problem: DamagedRecording | None
    limits: ReadLimits = LIMITS

    def records(self) -> Iterator[Record]:
        """Every message as bytes: each stream in the order of its sequence numbers, the streams by captured time.

        Gap messages come as stream `gap/archive`, the ends of streams as final envelopes. Raises the `problem`, if
        there is one, after everything that is right; Damage when a file changes under the reader's hands.
        """
        given: dict[str, tuple[int, int]] = {}
        for message in _in_time_order(self.chunks, self.limits):
            record = _record(self.description, message)
            if record is None:
                continue
            place = (record.envelope.epoch, record.envelope.sequence)
            if record.stream.signal is GAP or place > given.get(record.stream.name, (-1, -1)):
                given[record.stream.name] = place
                yield record
        if self.problem is not None:
            raise self.problem

    def messages(self) -> Iterator[Message]:
        """As `records`, decoded. Raises DecodeError for a payload that is not what its stream promises."""
        for stream, envelope, payload, _ in self.records():
            yield Message(stream, envelope, decode_payload(stream.signal, envelope, payload))


def open_recording(folder: Path, derived_version: str | None = None, limits: ReadLimits = LIMITS) -> Recording:
    """Scan a session folder: its raw files and one version of derived ones (default: the one written live).

    Open `.part` files count as far as they go. Raises NotARecording, OSError.
    """
    version = derived_version or _live_version(folder)
    files = [path for name, path in _without_copied_parts(folder) if name.version in (None, version)]
    clocks: dict[str, int] = {}
    scans = [scan(path, clocks, limits) for path in files]
    description = next((found.description for found in scans if found.description is not None), None)
    if description is None:
        raise NotARecording(f"{folder.name} holds no file of a recorded session")
    recording = _joined(folder, description, scans, limits)
    recording.problem = recording.problem or _missing(folder, version, {path.name for path in files})
    return recording


def _live_version(folder: Path) -> str | None:
    manifest = read_manifest(folder)
    if manifest is not None:
        return manifest.derived_version
    versions = {name.version for name, _ in segment_files(folder) if name.version is not None}
    if len(versions) > 1:
        raise NotARecording(f"{folder.name}: no manifest, and several derived versions: {sorted(versions)}; name one")
    return versions.pop() if versions else None


def _without_copied_parts(folder: Path) -> list[tuple[SegmentName, Path]]:
    files = segment_files(folder)
    closed = {name for name, _ in files if not name.part}
    return [(name, path) for name, path in files if not name.part or name.sealed not in closed]


def _joined(folder: Path, description: SessionDescription, scans: list[SegmentScan], limits: ReadLimits) -> Recording:
    recording = Recording(folder, description, [], Ledger(), None, limits)
    for kind in ("raw", "derived"):
        problem = _join(recording, [found for found in scans if found.path.name.startswith(kind)])
        recording.problem = recording.problem or problem
    return recording


def _join(recording: Recording, scans: list[SegmentScan]) -> DamagedRecording | None:
    """Take the files up to the first that is damaged or does not follow on what came before; that one's problem."""
    for found in scans:
        problem = _damage(found)
        if found.description is not None:
            if found.description != recording.description:
                return DamagedRecording(found.path, "belongs to another session")
            if not _follows(recording.ledger, found.ledger):
                return DamagedRecording(found.path, "the file before it is missing or damaged")
            recording.chunks += found.chunks
            recording.ledger.absorb(found.ledger.spans())
        if problem is not None:
            return problem
    return None


def _damage(found: SegmentScan) -> DamagedRecording | None:
    """An open file may end anywhere; a closed one must be whole."""
    is_part = found.path.name.endswith(PART_SUFFIX)
    if found.whole or (is_part and (found.damage is None or found.damage.kind is DamageKind.TRUNCATED)):
        return None
    return DamagedRecording(found.path, str(found.damage or "it was not closed"))


def _follows(known: Ledger, new: Ledger) -> bool:
    """No sequence number between the known and the new is missing; what nobody had is named by gap messages."""
    return all(span.first_sequence <= (known.expected(span.stream, span.epoch) or 0) for span in new.spans())


def _missing(folder: Path, version: str | None, present: set[str]) -> DamagedRecording | None:
    manifest = read_manifest(folder)
    if manifest is None:
        return None
    for entry in manifest.files:
        name = parse_file_name(entry.name)
        if name and name.version in (None, version) and entry.name not in present:
            return DamagedRecording(folder / entry.name, "the file is missing")
    return None


def _in_time_order(chunks: Iterable[ChunkSpan], limits: ReadLimits) -> Iterator[RawMessage]:
    """Merge chunks that overlap in time, holding no more of them than overlap.

    A message's time is its log time, but never before an earlier message of its stream.
    """
    files: dict[Path, BinaryIO] = {}
    waiting: list[_Waiting] = []
    held = 0
    numbered = sorted(enumerate(chunks), key=lambda item: (item[1].from_ns, item[0]))
    with ExitStack() as stack:
        for place, (number, span) in enumerate(numbered):
            if span.path not in files:
                files[span.path] = stack.enter_context(span.path.open("rb"))
            for entry in _timed(read_messages(files[span.path], span), span, number):
                heapq.heappush(waiting, entry)
                held += len(entry.message.data)
            if held > limits.open_bytes:
                raise ArchiveError(f"{span.path.name}: more than {limits.open_bytes} bytes recorded at the same time")
            until = numbered[place + 1][1].from_ns if place + 1 < len(numbered) else None
            while waiting and (until is None or waiting[0].log_time < until):
                message = heapq.heappop(waiting).message
                held -= len(message.data)
                yield message


def _timed(messages: Iterable[RawMessage], span: ChunkSpan, number: int) -> Iterator[_Waiting]:
    clocks = dict(span.clocks)
    for place, message in enumerate(messages):
        clock = message.clock
        clocks[clock] = max(message.log_time, clocks.get(clock, 0))
        yield _Waiting(clocks[clock], (number, place), message)


def _record(description: SessionDescription, message: RawMessage) -> Record | None:
    """None for what is not a stream: the session description, and signals of a newer Ambula."""
    if message.channel.topic == END_TOPIC:
        end = StreamEnd.model_validate_json(message.data)
        envelope = Envelope(end.epoch, end.sequence, end.captured_ns, final=True)
        return Record(Stream.parse(end.stream), envelope, b"", message.publish_time)
    parsed = parse_topic(message.channel.topic)
    if parsed is None or parsed[0].quality is Quality.STATE:
        return None
    envelope = Envelope(
        message.channel.epoch,
        message.sequence,
        captured_ns(description, message.log_time),
        schema_version=message.channel.schema_version,
    )
    return Record(Stream(*parsed), envelope, message.data, message.publish_time)
