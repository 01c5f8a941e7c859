"""Starting and stopping sessions: what the gateway asks of an ingest, without saying how it is reached."""

from dataclasses import dataclass
from typing import Literal, Protocol

from schemas.rhythm import KnownRhythm
from schemas.session import SessionDescription, WalkPath


class ControlUnavailable(RuntimeError):
    """No ingest can be reached just now."""


class ControlRefused(RuntimeError):
    """An ingest was reached and said no; the message is its reason."""


@dataclass(frozen=True, slots=True)
class StartRequest:
    """A session to be started. `speed` None plays as fast as the services follow.

    `estimator`, `walk_path` and `known_rhythms` None are what the source says.
    """

    session: str
    source: str
    speed: float | None
    estimator: str | None
    walk_path: WalkPath | None
    known_rhythms: list[KnownRhythm] | None


@dataclass(frozen=True, slots=True)
class Source:
    """Something that can be played as a session."""

    id: str
    title: str
    kind: Literal["recording", "synthetic"]
    duration_s: float | None


class Control(Protocol):
    """The way to the ingests. Every call may raise ControlUnavailable; waits a few seconds at most."""

    def start(self, request: StartRequest) -> SessionDescription:
        """Start a session. Raises ControlRefused with the ingest's reason."""

    def stop(self, session: str) -> None:
        """End a session's streams. Raises ControlRefused when the ingest does not run it."""

    def mark(self, session: str, last_s: float, at_s: float | None) -> tuple[float, float]:
        """Mark the last seconds as standing; the span, s of session time. Raises ControlRefused with the reason."""

    def recordings(self) -> list[Source]:
        """Recordings that an ingest has at hand."""


SYNTHETIC_SOURCES = (
    Source("synthetic:walk?speed=1.2&seed=1&duration=120", "Walk, comfortable speed", "synthetic", 120.0),
    Source("synthetic:walk?speed=0.7&seed=2&duration=120", "Walk, slow", "synthetic", 120.0),
    Source("synthetic:walk?speed=0.9&asymmetry=0.25&seed=3&duration=120", "Walk, uneven sides", "synthetic", 120.0),
)
"""Simulated walkers that are always there."""
