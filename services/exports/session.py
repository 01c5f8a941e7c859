"""A session as the formats read it: its description, and its messages of the kinds asked for, as often as needed."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Protocol

from schemas.gait import GaitEvent
from schemas.kinematics import Calibration
from schemas.metrics import SessionMetrics
from schemas.payload import Payload
from schemas.session import SessionDescription
from schemas.signals import CALIBRATION, METRICS, Signal
from services.exports.facts import Facts


class Session(Protocol):
    """Where messages come from."""

    @property
    def description(self) -> SessionDescription:
        """Who measured what."""

    @property
    def signals(self) -> frozenset[str]:
        """Names of the signals of which there is at least one message."""

    def payloads(self, *signals: Signal) -> Iterator[Payload]:
        """Messages of these signals in order of time, from the first. May be called again."""


class HeldSession:
    """A session whose messages are in memory: one that has just been computed."""

    def __init__(self, description: SessionDescription, payloads: Sequence[tuple[Signal, Payload]]) -> None:
        self.description = description
        self._payloads = payloads
        self.signals = frozenset(signal.name for signal, _ in payloads)

    def payloads(self, *signals: Signal) -> Iterator[Payload]:
        """As in `Session`."""
        return (payload for signal, payload in self._payloads if signal in signals)


def facts_of(session: Session) -> Facts:
    """What every file of a session says first: with its first calibration, and who computed it."""
    calibration = next(iter(session.payloads(CALIBRATION)), None) if CALIBRATION.name in session.signals else None
    metrics = newest_metrics(session)
    assert calibration is None or isinstance(calibration, Calibration)
    return Facts(session.description, calibration, None if metrics is None else metrics.software)


def newest_metrics(session: Session) -> SessionMetrics | None:
    """The last metrics, final ones once the session is over."""
    newest = None
    for payload in session.payloads(METRICS) if METRICS.name in session.signals else ():
        newest = payload
    assert newest is None or isinstance(newest, SessionMetrics)
    return newest


def events_among(payloads: Iterable[Payload]) -> list[GaitEvent]:
    """Foot contacts, in order of time."""
    events = (payload for payload in payloads if isinstance(payload, GaitEvent))
    return sorted(events, key=lambda event: event.captured_ns)
