"""A session as the formats read it: its description, and its messages of the kinds asked for, as often as needed."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple, Protocol

from schemas.gait import GaitEvent
from schemas.kinematics import Calibration
from schemas.metrics import SessionMetrics
from schemas.payload import Payload
from schemas.session import SessionDescription
from schemas.signals import CALIBRATION, GAIT_EVENT, JOINT_CENTRES, JOINT_STATE, METRICS, Signal
from services.exports.facts import Facts
from services.exports.motion import Motion, gather_motion
from services.flow.software import SOFTWARE


class Session(Protocol):
    """Where messages come from."""

    @property
    def description(self) -> SessionDescription:
        """Who measured what."""

    @property
    def signals(self) -> frozenset[str]:
        """Names of the signals of which there is at least one message."""

    @property
    def software(self) -> str | None:
        """What computed the messages; None where nothing says so."""

    def payloads(self, *signals: Signal) -> Iterator[Payload]:
        """Messages of these signals in order of time, from the first. May be called again."""


class HeldSession:
    """A session whose messages are in memory: one that has just been computed."""

    def __init__(
        self,
        description: SessionDescription,
        payloads: Sequence[tuple[Signal, Payload]],
        software: str | None = SOFTWARE,
    ) -> None:
        self.description = description
        self.software = software
        self._payloads = payloads
        self.signals = frozenset(signal.name for signal, _ in payloads)

    def payloads(self, *signals: Signal) -> Iterator[Payload]:
        """As in `Session`."""
        return (payload for signal, payload in self._payloads if signal in signals)


def facts_of(session: Session) -> Facts:
    """What every file of a session says first: with its first calibration, which comes before the first angles."""
    calibration = next(iter(session.payloads(CALIBRATION)), None) if CALIBRATION.name in session.signals else None
    assert calibration is None or isinstance(calibration, Calibration)
    return Facts(session.description, calibration, session.software)


class Contents(NamedTuple):
    """What a file of angles needs of a session, from one reading."""

    motion: Motion
    events: list[GaitEvent]
    metrics: SessionMetrics | None
    """The newest: final ones once the session is over."""


def contents_of(session: Session) -> Contents:
    """Raises ExportError as `gather_motion`."""
    events: list[GaitEvent] = []
    newest: list[SessionMetrics] = []

    def noted() -> Iterator[Payload]:
        for payload in session.payloads(JOINT_STATE, JOINT_CENTRES, GAIT_EVENT, METRICS):
            if isinstance(payload, GaitEvent):
                events.append(payload)
            elif isinstance(payload, SessionMetrics):
                newest[:] = [payload]
            else:
                yield payload

    motion = gather_motion(noted())
    events.sort(key=lambda event: event.captured_ns)
    return Contents(motion, events, newest[0] if newest else None)
