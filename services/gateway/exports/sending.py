"""Files on their way to somebody, stopped where their session is erased meanwhile."""

from collections.abc import Iterable


class Erased(RuntimeError):
    """What is being sent has just been erased: the connection ends before the file does."""


class Outgoing:
    """What one gateway must not send any more. Used from many threads."""

    def __init__(self) -> None:
        self._erased: set[str] = set()

    def check(self, session: str) -> None:
        """Raises Erased."""
        if session in self._erased:
            raise Erased(session)

    def stop(self, sessions: Iterable[str]) -> None:
        """Let no more of these sessions go out. A file that is being written for one is not sent either."""
        self._erased.update(sessions)
