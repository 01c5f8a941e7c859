"""How entries hang together: each digest covers the entry and the digest before it."""

import hashlib
import json
from dataclasses import asdict, dataclass
from datetime import UTC, datetime

BEGINNING = "0" * 64
"""What the first entry is chained to."""


@dataclass(frozen=True, slots=True)
class Entry:
    """Who did what with what, and how it ended.

    `actor`: id of an account or key, None for nobody known; `action`: name of the operation; `outcome`: HTTP status;
    `reason`: why, where the operation asks for it. No names: ids and codes only.
    """

    at: datetime
    actor_kind: str
    actor: str | None
    role: str | None
    clinic: str | None
    action: str
    patient: str | None
    session: str | None
    object: str | None
    outcome: int
    reason: str | None


def digest_of(number: int, entry: Entry, previous: str) -> str:
    """SHA-256 of an entry in its place, hexadecimal."""
    fields = asdict(entry) | {"at": entry.at.astimezone(UTC).isoformat(timespec="microseconds")}
    text = json.dumps([number, previous, fields], sort_keys=True, separators=(",", ":"), ensure_ascii=True)
    return hashlib.sha256(text.encode()).hexdigest()
