"""Counts of what was left out."""

from collections import Counter

from schemas.health import Reason, Rejection


class Tally:
    """Rejections by subject and reason, in the order in which each first occurred."""

    def __init__(self) -> None:
        self._counts: Counter[tuple[str, Reason]] = Counter()

    def add(self, subject: str, reason: Reason, count: int = 1) -> None:
        """Count; nothing is remembered of a count of zero."""
        if count > 0:
            self._counts[subject, reason] += count

    def rejections(self) -> list[Rejection]:
        """As health and reports carry them."""
        return [
            Rejection(subject=subject, reason=reason, count=count) for (subject, reason), count in self._counts.items()
        ]
