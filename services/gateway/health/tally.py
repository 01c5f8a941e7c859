"""Counts that only grow, though instances and sessions come and go: what services reported, added up per service."""

import threading
from collections import defaultdict
from typing import NamedTuple

from schemas.health import Health, Rejection
from schemas.vocabulary import Segment

POSITIONS = frozenset(segment.value for segment in Segment)


class Counted(NamedTuple):
    """What is counted: of which service, where on the body (empty: not a sensor), and why or what."""

    service: str
    position: str
    what: str


Source = tuple[Counted, str, str]
"""What a count is added to, and the session and subject it comes from, which are never shown."""


class Tally:
    """Fed with every report, in the order in which an instance sent them."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._last: dict[tuple[str, str], dict[Source, float]] = {}
        self._sums: defaultdict[Counted, float] = defaultdict(float)

    def take(self, health: Health) -> None:
        """Add what is new since the instance's last report."""
        told = _told(health)
        with self._lock:
            before = self._last.get((health.service, health.instance), {})
            for key, count in told.items():
                growth = count - before.get(key, 0.0)
                self._sums[key[0]] += growth if growth >= 0 else count
            self._last[health.service, health.instance] = told

    def forget(self, service: str, instance: str) -> None:
        """The instance is gone for good; its sums stay."""
        with self._lock:
            self._last.pop((service, instance), None)

    def sums(self) -> dict[Counted, float]:
        """Everything counted so far."""
        with self._lock:
            return dict(self._sums)


def _told(health: Health) -> dict[Source, float]:
    """A report's counts."""

    def of(what: str, position: str = "") -> Counted:
        return Counted(health.service, position, what)

    def refused(rejection: Rejection) -> Counted:
        return of(rejection.reason, rejection.subject if rejection.subject in POSITIONS else "")

    told: dict[Source, float] = {
        (of("cpu_s"), "", ""): health.cpu_s,
        (of("dropped"), "", ""): health.queue_dropped,
        (of("errors"), "", ""): health.errors,
    }
    told |= {(refused(each), "", each.subject): each.count for each in health.rejections}
    for session in health.sessions:
        told |= {(refused(each), session.session, each.subject): each.count for each in session.rejections}
        told |= {(of("lost"), session.session, each.stream): each.lost for each in session.inputs}
    return told
