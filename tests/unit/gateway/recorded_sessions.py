"""Sessions through the whole chain into the archive's files, with what a live page would have been shown."""

from pathlib import Path
from typing import NamedTuple

from schemas.kinematics import LivePose
from schemas.payload import Payload
from schemas.session import SessionDescription
from schemas.signals import LIVE_POSE
from services.archive.disk import Disk
from services.archive.manifest import new_manifest, store, with_files
from services.archive.seal import seal
from services.archive.writer import SessionWriter
from services.cli.assembly import build_chain
from services.faults.inject import Injection
from services.flow.message import Message, encode_payload
from services.ingest.source import iter_messages, open_source
from services.recordings.limits import MIB
from services.recordings.record import Record

VERSION = "0.1.0"


class RecordedSession(NamedTuple):
    """What lies in the archive, and what it was made of."""

    folder: Path
    description: SessionDescription
    shown: list[LivePose]
    """As estimation sent them to pages."""
    payloads: list[Payload]
    """All others, in the order in which they were sent."""


def record_session(data_dir: Path, session: str, spec: str, faults=(), **options) -> RecordedSession:
    """Run a source, with faults at its first hub, to its end, and archive all of it."""
    source = open_source(spec, **options)
    description = source.describe().model_copy(update={"session": session, "started_unix_ns": 1_790_000_000 * 10**9})
    folder = data_dir / session
    folder.mkdir(parents=True)
    disk = Disk()
    writer, chain = SessionWriter(folder, description, VERSION, disk=disk), build_chain(description)
    sensors = [sensor.name for hub in description.hubs[:1] for sensor in hub.sensors]
    shown, payloads = [], []
    for message in Injection(sensors, faults).apply(iter_messages(source)):
        for each in (message, *chain.push(message)):
            if each.stream.signal is LIVE_POSE:
                shown += [each.payload] if each.payload is not None else []
            elif each.stream.signal.archived is not None:
                writer.write(_record(each, description.started_unix_ns))
                payloads.append(each.payload)
    writer.flush()
    entries = [seal(part, f"ambula {VERSION}", disk, MIB) for part in writer.close()]
    store(folder, with_files(new_manifest(description, VERSION), [entry for entry in entries if entry]), disk)
    return RecordedSession(folder, description, shown, payloads)


def _record(message: Message, started_ns: int) -> Record:
    received_ns = started_ns + message.envelope.captured_ns
    return Record(message.stream, message.envelope, encode_payload(message.payload), received_ns)
