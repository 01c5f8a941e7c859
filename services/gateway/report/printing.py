"""One report is set at a time and one may wait: more would hold up everything else that the gateway has to answer."""

import threading
from http import HTTPStatus

from services.gateway.problems import Problem
from services.report.content import Report
from services.report.press import press

MOST_AT_ONCE = 2
_places = threading.BoundedSemaphore(MOST_AT_ONCE)


class Busy(Problem):
    """Somebody else's reports come first."""

    retry_after_s = 2

    def __init__(self) -> None:
        detail = "Other reports are being printed just now."
        super().__init__(HTTPStatus.SERVICE_UNAVAILABLE, detail, f"Try again in {self.retry_after_s} s.")


def printed(report: Report) -> bytes:
    """The report as PDF. Raises Busy."""
    if not _places.acquire(blocking=False):
        raise Busy
    try:
        return press().pdf(report)
    finally:
        _places.release()
