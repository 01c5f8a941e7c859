"""What a source cannot know from its data: the session's id, its wall clock, and what the operator chose."""

import re
import secrets
import time
from dataclasses import dataclass

from services.ingest.choices import AS_THE_SOURCE_SAYS, Choices
from services.ingest.errors import InvalidOption

_SESSION_PATTERN = re.compile(r"[a-z0-9][a-z0-9_-]{0,63}")


@dataclass(frozen=True, slots=True)
class Identity:
    """One playing of a source."""

    session: str
    started_unix_ns: int
    choices: Choices = AS_THE_SOURCE_SAYS

    @classmethod
    def new(cls, session: str | None = None, choices: Choices = AS_THE_SOURCE_SAYS) -> "Identity":
        """A fresh session that starts now. Raises InvalidOption for an id that cannot stand in a key."""
        if session is not None and _SESSION_PATTERN.fullmatch(session) is None:
            raise InvalidOption(f"session {session!r}: use lower-case letters, digits, - and _, at most 64")
        return cls(session or secrets.token_hex(8), time.time_ns(), choices)
