"""How a session lies in an MCAP file: names shared by whoever writes one and whoever reads it. Standards only, no codec.

Topic `{signal}/{source}`, message encoding `json`, schema encoding `jsonschema` with the model's published schema,
`sequence` = the envelope's, `log_time` = wall clock of capture. The end of a stream is a message with empty data.
"""

from schemas.session import SessionDescription
from schemas.signals import SESSION, Signal

PROFILE = "ambula"
MESSAGE_ENCODING = "json"
SCHEMA_ENCODING = "jsonschema"

SESSION_METADATA = "ambula.session"
"""Name of the MCAP metadata record that repeats the session description, one JSON text under `DESCRIPTION_FIELD`."""
DESCRIPTION_FIELD = "description"

SESSION_TOPIC = f"{SESSION.name}/{SESSION.producer}"
"""Topic of the session description as a message, before the first sample."""


def topic(signal: Signal, source: str) -> str:
    """Topic of one stream."""
    return f"{signal.name}/{source}"


def channel_metadata(session: str, epoch: int, schema_version: str) -> dict[str, str]:
    """What every channel states about itself. A new epoch of a stream is a new channel of the same topic."""
    return {"session": session, "epoch": str(epoch), "schema_version": schema_version}


def log_time_ns(description: SessionDescription, captured_ns: int) -> int:
    """Wall clock of capture, ns since the Unix epoch."""
    return description.started_unix_ns + captured_ns


def captured_ns(description: SessionDescription, log_time: int) -> int:
    """Session time of a record's log time, ns; inverse of `log_time_ns`."""
    return log_time - description.started_unix_ns
