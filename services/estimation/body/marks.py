"""Standing that the operator marks, while the session runs or in its description, and what the page says of it."""

from collections.abc import Iterable

from schemas.session import StandingInterval
from schemas.standing import StandingMark
from services.flow.node import State


class StandingMarks:
    """Marks wait until a frame later than they were given; those of a description, until they are over."""

    def __init__(self, standing: Iterable[StandingInterval], notice_s: float) -> None:
        self._notice_ns = round(notice_s * 1e9)
        self._given = [StandingMark(from_ns=s.from_ns, to_ns=s.to_ns, given_ns=s.to_ns) for s in standing]
        self._notice, self._notice_until_ns = "", 0

    def note(self, marks: Iterable[StandingMark]) -> None:
        """Marks of a message."""
        self._given += marks

    def due(self, now_ns: int) -> list[StandingMark]:
        """Those that count from this frame on. Handed out once."""
        if not self._given:
            return []
        due = [mark for mark in self._given if now_ns > mark.given_ns]
        self._given = [mark for mark in self._given if mark not in due]
        return due

    def say(self, notice: str, now_ns: int) -> None:
        """What the screen says for the next seconds."""
        self._notice, self._notice_until_ns = notice, now_ns + self._notice_ns

    def notice_at(self, captured_ns: int) -> str:
        """What the screen says now."""
        return self._notice if captured_ns <= self._notice_until_ns else ""

    def snapshot(self) -> State:
        """Which marks wait, what the screen says."""
        return {
            "given": [mark.model_dump() for mark in self._given],
            "notice": [self._notice, self._notice_until_ns],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._given = [StandingMark(**mark) for mark in state["given"]]
        self._notice, self._notice_until_ns = state["notice"]
