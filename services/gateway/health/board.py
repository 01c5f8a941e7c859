"""The last word of every service, and who has gone silent."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from schemas.health import Health, Readiness, Reason
from services.gateway.health.tally import Tally

SERVICES = ("ingest", "estimation", "segmentation", "metrics", "archive")
"""Services that a working floor needs beside the gateway."""

FORGET_S = 300.0
"""s after which a silent instance is taken for retired and no longer listed."""


@dataclass(frozen=True, slots=True)
class Report:
    """One health message and when it came."""

    health: Health
    received_s: float


class HealthBoard:
    """Written by the feed, read by routes: one dict whose entries are replaced whole."""

    def __init__(self, stale_s: float, clock: Callable[[], float] = time.monotonic) -> None:
        self._stale_s = stale_s
        self._clock = clock
        self.tally = Tally()
        self._reports: dict[tuple[str, str], Report] = {}

    def record(self, health: Health) -> None:
        """A service reported on itself."""
        now = self._clock()
        for key in [key for key, report in self._reports.items() if now - report.received_s >= FORGET_S]:
            del self._reports[key]
            self.tally.forget(*key)
        self._reports[health.service, health.instance] = Report(health, now)
        self.tally.take(health)

    def reports(self) -> list[tuple[Health, float]]:
        """Each instance's last report with its age in s, by name."""
        now = self._clock()
        listed = [(report.health, now - report.received_s) for report in list(self._reports.values())]
        recent = [(health, age) for health, age in listed if age < FORGET_S]
        return sorted(recent, key=lambda each: (each[0].service, each[0].instance))

    def preparing(self) -> list[str]:
        """Needed services that are there but do not work yet: what they run is being compiled."""
        told = [(health.service, health.readiness) for health, age in self.reports() if not self.is_stale(age)]
        at_work = {service for service, readiness in told if readiness is Readiness.READY}
        return [name for name in SERVICES if name not in at_work and name in dict(told)]

    def silent(self) -> list[str]:
        """Needed services of which no instance has reported lately."""
        heard = {health.service for health, age in self.reports() if not self.is_stale(age)}
        return [name for name in SERVICES if name not in heard]

    def is_stale(self, age_s: float) -> bool:
        """Whether a report of that age means that the service is silent."""
        return age_s > self._stale_s

    def recording_stopped(self, session: str) -> Literal["disk", "refused"] | None:
        """Why the archive does not record a session just now: no space, or the disk refuses. None while it does,
        or while nobody knows."""
        for health, age in self.reports():
            if health.service != "archive" or self.is_stale(age):
                continue
            own = [found for each in health.sessions if each.session == session for found in each.rejections]
            if any(found.reason is Reason.NOT_RECORDED for found in own):
                full = any(found.reason is Reason.DISK_LOW for found in health.rejections)
                return "disk" if full else "refused"
        return None

    def brief(self) -> dict[str, Any]:
        """For every screen: is anybody out there, and who is not."""
        silent = self.silent()
        return {"connected": len(silent) < len(SERVICES), "silent": silent, "preparing": self.preparing()}
