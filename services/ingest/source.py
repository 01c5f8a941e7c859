"""Open any source by its specification, and read it as messages."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from schemas.archive_layout import PART_SUFFIX
from schemas.rhythm import KnownRhythm
from schemas.session import WalkPath
from schemas.vocabulary import Task
from services.flow.message import Envelope, Message
from services.flow.raw_streams import raw_streams
from services.ingest.batching import Batcher
from services.ingest.capture.ports import CapturePorts
from services.ingest.capture.source import open_device
from services.ingest.choices import AS_THE_SOURCE_SAYS, Choices
from services.ingest.data import MANIFESTS, data_folders
from services.ingest.driver import Source, SourceMessage
from services.ingest.errors import SourceError, UnknownSource
from services.ingest.identity import Identity
from services.ingest.manifest import FILE_NAME
from services.ingest.mcap_file import McapRecording, raw_files
from services.ingest.recording import Recording
from services.ingest.synthetic.source import open_synthetic

__all__ = ["Source", "SourceError", "SourceMessage", "iter_messages", "known_recordings", "open_chosen", "open_source"]


def known_recordings() -> dict[str, Path]:
    """Recordings that can be opened by name, with their manifests: those the software describes, and folders with a
    recording.toml among the data."""
    found = {path.stem: path for path in sorted(MANIFESTS.glob("*.toml"))}
    for folder in data_folders():
        for path in sorted(folder.glob(f"*/{FILE_NAME}")):
            found.setdefault(path.parent.name, path)
    return found


def open_source(
    spec: str,
    *,
    session: str | None = None,
    estimator: str | None = None,
    walk_path: WalkPath | None = None,
    known_rhythms: Sequence[KnownRhythm] | None = None,
    task: Task | None = None,
    walkway_m: float | None = None,
) -> Source:
    """`open_chosen` with the choices by name."""
    known = None if known_rhythms is None else tuple(known_rhythms)
    return open_chosen(spec, Choices(estimator, walk_path, known, task, walkway_m), session=session)


def open_chosen(
    spec: str,
    choices: Choices = AS_THE_SOURCE_SAYS,
    *,
    session: str | None = None,
    ports: CapturePorts | None = None,
) -> Source:
    """Open a recording folder, a manifest, an .mcap file or an archived session's folder, a known recording's name,
    `synthetic:walk?speed=1.1` or another synthetic motion, or a device: `device:kinect?port=7788`.

    A device is a LiveSource: it runs from now on and must be closed. `ports` are those that the process listens on
    already. `session` None takes a random id. Raises SourceError, saying what is wrong where and what to do.
    """
    identity = Identity.new(session, choices)
    scheme, separator, rest = spec.partition(":")
    if separator and scheme == "synthetic":
        return open_synthetic(rest, identity)
    if separator and scheme == "device":
        return open_device(rest, identity, ports)
    named = known_recordings()
    if spec in named:
        return Recording(named[spec], identity)
    path = Path(spec)
    if path.suffix == ".toml":
        return Recording(path, identity)
    if path.suffix == ".mcap" or path.name.endswith(f".mcap{PART_SUFFIX}"):
        return McapRecording([path], identity)
    if path.is_dir():
        archived = [] if (path / FILE_NAME).exists() else raw_files(path)
        return McapRecording(archived, identity) if archived else Recording(path / FILE_NAME, identity)
    raise UnknownSource(
        f"{spec[:200]!r} is no folder with {FILE_NAME}, no .mcap file, neither synthetic:walk nor synthetic:march, "
        "no device:kinect?port=7788, "
        f"and no known recording ({', '.join(named)})"
    )


def iter_messages(source: Source, ticks: int = 1) -> Iterator[Message]:
    """Every message of a source as live publishing sends it: numbered from zero, each stream closed at its end."""
    sequences = dict.fromkeys(raw_streams(source.describe()), 0)
    last_ns = dict.fromkeys(sequences, 0)
    for stream, captured_ns, payload in in_batches(source.messages(), ticks):
        yield Message(stream, Envelope(0, sequences[stream], captured_ns), payload)
        sequences[stream] += 1
        last_ns[stream] = captured_ns
    for stream, sequence in sequences.items():
        yield Message(stream, Envelope(0, sequence, last_ns[stream], final=True), None)


def in_batches(messages: Iterator[SourceMessage], ticks: int) -> Iterator[SourceMessage]:
    """Join `ticks` consecutive messages of a stream into one; what is incomplete at the end comes last."""
    batcher = Batcher(ticks)
    for message in messages:
        yield from batcher.add(message)
    yield from batcher.flush()
