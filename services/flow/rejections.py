"""Counting what was not used, by subject and reason."""

from collections import Counter

from schemas.health import Reason, Rejection


class RejectionCounter:
    """How often each subject was rejected for each reason."""

    def __init__(self) -> None:
        self._counts: Counter[tuple[str, Reason]] = Counter()

    def add(self, subject: str, reason: Reason, count: int = 1) -> None:
        """One more, or `count` more; nothing is remembered of a count of zero."""
        if count > 0:
            self._counts[subject, reason] += count

    def report(self) -> list[Rejection]:
        """In the order of subject and reason."""
        return [
            Rejection(subject=subject, reason=reason, count=count)
            for (subject, reason), count in sorted(self._counts.items())
        ]
