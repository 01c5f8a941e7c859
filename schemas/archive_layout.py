"""How a session lies in an MCAP file: names shared by whoever writes one and whoever reads it. Constants, no codec.

One folder per session. Every file is ordinary MCAP with JSON channels; `services/archive/README.md` shows how to
open one. In a message record, `log_time` is the wall time of capture, `publish_time` the wall time of arrival and
`sequence` the envelope's; a channel holds one epoch of one stream.
"""

import re
from enum import StrEnum
from typing import Literal, NamedTuple

from pydantic import Field

from schemas.payload import Payload, SessionTime
from schemas.session import SessionDescription
from schemas.signals import BY_NAME, SESSION, Signal

PROFILE = "ambula"
MESSAGE_ENCODING = "json"
SCHEMA_ENCODING = "jsonschema"

SESSION_METADATA = "ambula.session"
"""Name of the MCAP metadata record that repeats the session description, JSON under `DESCRIPTION_FIELD`."""
DESCRIPTION_FIELD = "description"
DESCRIPTION_SHA256_KEY = "description_sha256"
SEGMENT_KEY = "segment"
SOFTWARE_KEY = "software"

SESSION_KEY = "session"
EPOCH_KEY = "epoch"
SCHEMA_VERSION_KEY = "schema_version"
TIME_UNIT_KEY = "time_unit"
TIME_UNIT = "ns"
"""The four keys of every channel's metadata; the session record has all but `epoch`."""

SESSION_TOPIC = f"{SESSION.name}/{SESSION.producer}"
"""Topic of the session description as a message, before the first sample of every file."""
END_TOPIC = "stream_end/archive"
"""Channel of `StreamEnd` messages: the envelopes that closed a stream, which have no payload of their own."""

MANIFEST_FILE = "manifest.json"
PART_SUFFIX = ".part"
DAMAGED_SUFFIX = ".damaged"
CHECKPOINT_PREFIX = "checkpoint-"

Kind = Literal["raw", "derived"]
_SESSION = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,63}")
_VERSION = r"[A-Za-z0-9][A-Za-z0-9.+-]*"
_FILE = re.compile(rf"(?:raw|derived-(?P<version>{_VERSION}))(?:_(?P<number>[0-9]{{3,6}}))?\.mcap(?P<part>\.part)?")


class StreamEnd(Payload):
    """A producer closed its stream after the message before this sequence number."""

    stream: str = Field(description="signal/source")
    epoch: int = Field(description="epoch of the closed stream, dimensionless")
    sequence: int = Field(ge=0, description="sequence number of the closing message")
    captured_ns: SessionTime


class SegmentName(NamedTuple):
    """What a file name says. A recording starts with number 0; each rotation or restart takes the next.

    `version` is the software that computed a derived file, None for raw ones; `part` is true while it is open.
    """

    kind: Kind
    version: str | None
    number: int
    part: bool

    @property
    def file_name(self) -> str:
        """`raw.mcap`, `raw_001.mcap`, `derived-0.1.0+1f2e3d4c.mcap`, ... with `.part` while open."""
        stem = "raw" if self.version is None else f"derived-{self.version}"
        suffix = f"_{self.number:03d}" if self.number else ""
        return f"{stem}{suffix}.mcap{PART_SUFFIX if self.part else ''}"

    @property
    def sealed(self) -> "SegmentName":
        """The same segment, closed."""
        return self._replace(part=False)


def parse_file_name(name: str) -> SegmentName | None:
    """Inverse of `SegmentName.file_name`; None for a file that is no segment."""
    match = _FILE.fullmatch(name)
    if match is None:
        return None
    version = match["version"]
    return SegmentName("raw" if version is None else "derived", version, int(match["number"] or 0), bool(match["part"]))


def folder_name(session: str) -> str:
    """The session's folder. Raises ValueError for an id that could not safely name one."""
    if not _SESSION.fullmatch(session):
        raise ValueError(f"session id {session[:80]!r}: only letters, digits, _ and - are allowed, at most 64")
    return session


def topic(signal: Signal, source: str) -> str:
    """MCAP topic of a stream: `imu/hub`."""
    return f"{signal.name}/{source}"


def parse_topic(topic: str) -> tuple[Signal, str] | None:
    """Inverse of `topic`; None for a topic that is not a signal of the table (such as `END_TOPIC`)."""
    name, _, source = topic.partition("/")
    return (BY_NAME[name], source) if name in BY_NAME and source else None


def channel_metadata(session: str, epoch: int, schema_version: str) -> dict[str, str]:
    """Metadata of the channel that holds one epoch of one stream."""
    return {
        SESSION_KEY: session,
        EPOCH_KEY: str(epoch),
        SCHEMA_VERSION_KEY: schema_version,
        TIME_UNIT_KEY: TIME_UNIT,
    }


def log_time_ns(description: SessionDescription, captured_ns: int) -> int:
    """Session time to MCAP log time, ns since the Unix epoch."""
    return description.started_unix_ns + captured_ns


def captured_ns(description: SessionDescription, log_time: int) -> int:
    """MCAP log time to session time, ns since the session started; inverse of `log_time_ns`."""
    return log_time - description.started_unix_ns


class RecordingState(StrEnum):
    """How far a recording has come."""

    RECORDING = "recording"
    FINISHED = "finished"
    INTERRUPTED = "interrupted"
    STOPPED = "stopped"


class StreamSpan(Payload):
    """What a file holds of one epoch of one stream: first..last, without holes that no gap message names."""

    stream: str = Field(description="signal/source")
    epoch: int = Field(description="producer's incarnation, dimensionless")
    first_sequence: int = Field(ge=0, description="first sequence number in the file")
    last_sequence: int = Field(ge=0, description="last sequence number in the file, the end of the stream included")
    count: int = Field(ge=0, description="number of messages")
    last_captured_ns: SessionTime
    ended: bool = Field(description="the producer closed the stream")


class SegmentEntry(Payload):
    """One closed file of a session."""

    name: str
    size_bytes: int = Field(ge=0, description="bytes")
    sha256: str
    messages: int = Field(ge=0, description="number of messages, gaps and stream ends included")
    streams: list[StreamSpan]
    damage: str | None = Field(description="why the file ends before what was recorded; null when it does not")


class Manifest(Payload):
    """`manifest.json`: what a session folder holds. Can be rebuilt from the files."""

    session: str
    title: str
    protocol: str
    origin: str
    estimator: str
    started_unix_ns: int = Field(description="ns since the Unix epoch at session time zero")
    duration_s: float = Field(ge=0, description="s from session time zero to the newest archived sample")
    state: RecordingState
    state_reason: str | None = Field(description="what to do next, when the recording stopped; else null")
    derived_version: str = Field(description="version of the derived files that were written live")
    files: list[SegmentEntry]
