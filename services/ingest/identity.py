"""What a source cannot know from its data: the session's id, its wall clock, and what the operator chose."""

import re
import secrets
import time
from collections.abc import Sequence
from dataclasses import dataclass

from schemas.rhythm import KnownRhythm
from schemas.session import WalkPath
from schemas.vocabulary import ESTIMATORS
from services.ingest.errors import InvalidOption

_SESSION_PATTERN = re.compile(r"[a-z0-9][a-z0-9_-]{0,63}")


@dataclass(frozen=True, slots=True)
class Identity:
    """`estimator`, `walk_path` and `known_rhythms` None leave the choice to the source."""

    session: str
    started_unix_ns: int
    estimator: str | None = None
    walk_path: WalkPath | None = None
    known_rhythms: tuple[KnownRhythm, ...] | None = None

    @classmethod
    def new(
        cls,
        session: str | None = None,
        estimator: str | None = None,
        walk_path: WalkPath | None = None,
        known_rhythms: Sequence[KnownRhythm] | None = None,
    ) -> "Identity":
        """A fresh session that starts now. Raises InvalidOption for an id that cannot stand in a key."""
        if session is not None and _SESSION_PATTERN.fullmatch(session) is None:
            raise InvalidOption(f"session {session!r}: use lower-case letters, digits, - and _, at most 64")
        if estimator is not None and estimator not in ESTIMATORS:
            raise InvalidOption(f"estimator {estimator!r} is unknown; choose one of {', '.join(ESTIMATORS)}")
        known = None if known_rhythms is None else tuple(known_rhythms)
        if known is not None and len({each.kind for each in known}) < len(known):
            raise InvalidOption("known_rhythms: give at most one previous trial, one previous visit and one exemplar")
        return cls(session or secrets.token_hex(8), time.time_ns(), estimator, walk_path, known)
