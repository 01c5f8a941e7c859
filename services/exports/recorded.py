"""A recorded session as the formats read it. The only module here that opens files."""

from collections.abc import Callable, Iterator
from pathlib import Path

from schemas.archive_layout import Manifest, parse_file_name
from schemas.payload import Payload
from schemas.session import SessionDescription
from schemas.signals import Signal
from services.flow.message import decode_payload
from services.recordings.folder import read_manifest
from services.recordings.reader import open_recording

Told = Callable[[float], None]


class RecordedSession:
    """The derived messages of a session folder; raw samples are not read again.

    `told` hears s of session time as reading goes on. Reading raises DamagedRecording after everything that is right.
    """

    def __init__(self, folder: Path, derived_version: str | None = None, told: Told | None = None) -> None:
        """Raises NotARecording, OSError."""
        self._recording = open_recording(folder, derived_version)
        derived = [span for span in self._recording.chunks if span.path.name.startswith("derived")]
        self._recording.chunks = derived
        names = (parse_file_name(span.path.name) for span in derived)
        self._version = next((name.version for name in names if name is not None), None)
        self._told = told or (lambda _: None)
        spans = (span for span in self._recording.ledger.spans() if span.count > span.ended)
        self._signals = frozenset(span.stream.partition("/")[0] for span in spans)

    @property
    def description(self) -> SessionDescription:
        """Who measured what."""
        return self._recording.description

    @property
    def software(self) -> str | None:
        """What computed the messages, as the names of the derived files say."""
        return None if self._version is None else f"ambula {self._version}"

    @property
    def signals(self) -> frozenset[str]:
        """Names of the signals of which there is at least one message."""
        return self._signals

    def payloads(self, *signals: Signal) -> Iterator[Payload]:
        """Messages of these signals in order of time. Raises DamagedRecording, DecodeError."""
        for stream, envelope, payload, _ in self._recording.records():
            if stream.signal not in signals:
                continue
            self._told(envelope.captured_ns * 1e-9)
            decoded = decode_payload(stream.signal, envelope, payload)
            if decoded is not None:
                yield decoded


def listed_signals(folder: Path, derived_version: str | None = None) -> frozenset[str]:
    """Signals of a session folder as its manifest lists them, without opening a recording. Raises OSError."""
    manifest = read_manifest(folder)
    return frozenset() if manifest is None else _listed(manifest, derived_version or manifest.derived_version)


def _listed(manifest: Manifest, version: str) -> frozenset[str]:
    found = set()
    for entry in manifest.files:
        name = parse_file_name(entry.name)
        if name is not None and name.version in (None, version):
            found |= {span.stream.partition("/")[0] for span in entry.streams if span.count > span.ended}
    return frozenset(found)
