"""How the parts of Ambula are: one message per service and second."""

from enum import StrEnum

from pydantic import Field

from schemas.payload import Payload, SessionTime


class Reason(StrEnum):
    """Why a sample or message was not used."""

    NOT_FINITE = "not_finite"
    CLOCK_BACKWARDS = "clock_backwards"
    STUCK = "stuck"
    OUT_OF_RANGE = "out_of_range"
    WRONG_UNITS = "wrong_units"
    UNDECODABLE = "undecodable"
    UNKNOWN_SENSOR = "unknown_sensor"
    UNKNOWN_SENDER = "unknown_sender"
    UNKNOWN_SESSION = "unknown_session"
    WRONG_SHAPE = "wrong_shape"
    LATE = "late"
    MALFORMED_ROW = "malformed_row"
    QUEUE_FULL = "queue_full"
    DISK_LOW = "disk_low"
    NOT_RECORDED = "not_recorded"


class Readiness(StrEnum):
    """Whether a service does its work already."""

    COMPILING = "compiling"
    """What runs per sample is being compiled; the first start on a machine takes a minute and a half."""
    READY = "ready"


class Rejection(Payload):
    """How often something was rejected for one reason since the service or session started."""

    subject: str = Field(description="sensor, stream or file")
    reason: Reason
    count: int = Field(ge=0, description="number of samples or messages")


class StreamCount(Payload):
    """Bookkeeping of one input stream: received + recovered + lost = sent."""

    stream: str = Field(description="signal/source")
    received: int = Field(ge=0, description="messages used, each once")
    recovered: int = Field(ge=0, description="messages of those that came by replay")
    duplicated: int = Field(ge=0, description="messages dropped because they were known")
    lost: int = Field(ge=0, description="messages that nobody has any more")


class SessionHealth(Payload):
    """One session as one service sees it."""

    session: str
    captured_ns: SessionTime
    inputs: list[StreamCount]
    rejections: list[Rejection]


class Health(Payload):
    """A service's report on itself."""

    service: str
    instance: str
    uptime_s: float = Field(ge=0, description="s on the monotonic clock")
    cpu_s: float = Field(ge=0, description="s of processor time used since the start")
    rss_bytes: int = Field(ge=0, description="resident memory, bytes")
    queue_length: int = Field(ge=0, description="number of messages waiting")
    queue_capacity: int = Field(ge=0, description="number of messages that may wait")
    queue_dropped: int = Field(ge=0, description="number of messages dropped because the queue was full")
    errors: int = Field(ge=0, description="number of unexpected exceptions since the start; each is in the log")
    rejections: list[Rejection] = Field(description="what could not be tied to a session")
    sessions: list[SessionHealth]
    readiness: Readiness = Field(description="ready, or what it still does before it works")


class Gap(Payload):
    """A span of a stream that nobody has any more; written, never stitched over."""

    stream: str = Field(description="signal/source")
    epoch: int = Field(description="epoch of the missing messages, dimensionless")
    first_sequence: int = Field(ge=0, description="first missing sequence number")
    last_sequence: int = Field(ge=0, description="last missing sequence number")


class Progress(Payload):
    """How far a consumer has come with a session: used to pace replays and as the archive's durable offset."""

    service: str
    captured_ns: SessionTime
    positions: dict[str, int] = Field(description="signal/source -> last sequence number done")
    ended: bool = Field(description="all streams of the session that it waits for have ended, and all is done")
