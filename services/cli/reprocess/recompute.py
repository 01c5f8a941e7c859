"""One archived session through today's nodes: its raw streams in, and what comes out beside what was stored."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from schemas.archive_layout import RecordingState
from schemas.health import Gap
from schemas.metrics import SessionMetrics
from schemas.session import SessionDescription
from schemas.signals import GAP, METRICS
from services.cli.reprocess.fingerprints import Fingerprints, StreamDifference
from services.flow.chain import Chain
from services.flow.message import DecodeError, Envelope, Message, Stream, decode_payload, encode_payload
from services.flow.raw_streams import raw_streams
from services.flow.software import SOFTWARE, VERSION
from services.recordings.errors import ArchiveError, DamagedRecording
from services.recordings.folder import derived_versions, read_manifest
from services.recordings.reader import Recording, open_recording
from services.recordings.record import Record

OnProgress = Callable[[float], object]
"""Told how much of the session has been computed, 0 to 1."""
Keep = Callable[[Record], None]
"""Handed every recomputed message that an archive keeps."""


class CannotRecompute(ArchiveError):
    """There is nothing whole to compute from; says why and what to do."""


class UnderWay(CannotRecompute):
    """The session is not over; nothing is wrong with it."""


@dataclass
class Recomputed:
    """What became of one session. `stored` is the newest result there was, None where there was none."""

    description: SessionDescription
    stored_version: str | None
    length_s: float
    stored: SessionMetrics | None = None
    metrics: SessionMetrics | None = None
    same_messages: bool = False
    lateness_decided: bool = False
    """Of sensors beside a camera, which samples met was decided live by how late each was; no file tells that."""
    differing: list[StreamDifference] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    @property
    def same_software(self) -> bool:
        """The stored result says that this very software computed it."""
        return self.stored_version == VERSION and (self.stored is None or self.stored.software == SOFTWARE)

    @property
    def broken(self) -> bool:
        """The same software has come to something else: the archive or this machine cannot be relied on."""
        return self.same_software and not self.same_messages and not self.lateness_decided


@dataclass(frozen=True)
class Archived:
    """A closed session whose raw files are whole. `version` is that of the stored result to compare with."""

    recording: Recording
    version: str | None


def open_archived(folder: Path) -> Archived:
    """Look through a session's files. Raises CannotRecompute, ArchiveError, OSError."""
    manifest = read_manifest(folder)
    if manifest is not None and manifest.state in (RecordingState.RECORDING, RecordingState.STOPPED):
        raise UnderWay("is not closed: end the session, or start the archive once, which closes what was left open")
    versions = derived_versions(folder)
    version = VERSION if VERSION in versions else versions[-1] if versions else None
    recording = open_recording(folder, version or "none")
    _check(recording)
    return Archived(recording, version)


def recompute(archived: Archived, on_progress: OnProgress = float, keep: Keep | None = None) -> Recomputed:
    """Compute a session anew from its raw files. Raises CannotRecompute, ArchiveError, OSError."""
    return _Run(archived, on_progress, keep).run()


def _check(recording: Recording) -> None:
    """Raises CannotRecompute."""
    problem = recording.problem
    if problem is not None and problem.path.name.startswith("raw"):
        raise CannotRecompute(str(problem))
    held = recording.ledger.positions()
    if not any(stream.name in held for stream in raw_streams(recording.description)):
        raise CannotRecompute("holds nothing of its sensors or cameras; restore its raw files from a backup")


class _Run:
    """One pass over the recording: raw messages into the nodes, stored ones only looked at."""

    def __init__(self, archived: Archived, on_progress: OnProgress, keep: Keep | None) -> None:
        # Here, for the filters take seconds to import and a damaged session needs none.
        from services.cli.assembly import build_chain

        recording, description = archived.recording, archived.recording.description
        self._recording = recording
        self._on_progress = on_progress
        self._keep = keep
        self._chain: Chain = build_chain(description)
        self._open = dict.fromkeys(raw_streams(description), Envelope(0, -1, 0))
        self._length_ns = max(1, recording.ledger.captured_ns())
        self._stored, self._new = Fingerprints(), Fingerprints()
        self._stored_metrics: SessionMetrics | None = None
        self._metrics: SessionMetrics | None = None
        self._lost = 0
        self._told = 0.0
        self.result = Recomputed(
            description,
            archived.version,
            self._length_ns / 1e9,
            lateness_decided=bool(description.hubs and description.cameras),
        )

    def run(self) -> Recomputed:
        """Raises CannotRecompute, ArchiveError, OSError."""
        result = self.result
        try:
            for record in self._recording.records():
                self._take(record)
        except DamagedRecording as error:
            result.notes.append(f"what was stored of version {result.stored_version} is damaged: {error}")
        except DecodeError as error:
            raise CannotRecompute(f"holds a message that is none: {error}") from error
        complete = self._close_open()
        if self._lost:
            result.notes.append(f"{self._lost} messages were lost when it was recorded; the nodes may have seen them")
        result.stored, result.metrics = self._stored_metrics, self._metrics
        result.differing = self._stored.differing_from(self._new, complete=complete and self._recording.problem is None)
        result.same_messages = not result.differing and self._recording.problem is None
        self._on_progress(1.0)
        return result

    def _take(self, record: Record) -> None:
        stream, envelope, payload, _ = record
        if stream in self._open:
            self._push(Message(stream, envelope, decode_payload(stream.signal, envelope, payload)))
        elif stream.signal is GAP:
            self._lost += _missing(record)
        elif stream.signal.archived == "derived":
            self._stored.add(stream.name, envelope, payload)
            if stream.signal is METRICS and payload:
                self._stored_metrics = SessionMetrics.model_validate_json(payload)

    def _push(self, message: Message) -> None:
        self._open[message.stream] = message.envelope
        for produced in self._chain.push(message):
            self._made(produced)
        share = message.envelope.captured_ns / self._length_ns
        if share - self._told > 0.005:
            self._told = share
            self._on_progress(min(share, 1.0))

    def _made(self, message: Message) -> None:
        if message.stream.signal.archived is None:
            return
        payload = encode_payload(message.payload)
        self._new.add(message.stream.name, message.envelope, payload)
        if isinstance(message.payload, SessionMetrics):
            self._metrics = message.payload
        if self._keep is not None:
            self._keep(Record(message.stream, message.envelope, payload, 0))

    def _close_open(self) -> bool:
        """Close streams that the recording does not; whether it had closed all of them."""
        open_streams = [stream for stream, last in self._open.items() if not last.final]
        for stream in open_streams:
            last = self._open[stream]
            end = Envelope(last.epoch, last.sequence + 1, last.captured_ns, final=True)
            self._push(Message(stream, end, None))
        if open_streams:
            self.result.notes.append("the recording was interrupted; the result is that of what was recorded")
        return not open_streams


def _missing(record: Record) -> int:
    """Number of messages that a gap message is about, where it is about the sensors' own."""
    gap = decode_payload(GAP, record.envelope, record.payload)
    if not isinstance(gap, Gap) or Stream.parse(gap.stream).signal.archived != "raw":
        return 0
    return gap.last_sequence - gap.first_sequence + 1
