"""Files on their way to somebody, stopped where their session is erased meanwhile."""

from collections.abc import Iterable

_erased: set[str] = set()


class Erased(RuntimeError):
    """What is being sent has just been erased: the connection ends before the file does."""


def check_there(session: str) -> None:
    """Raises Erased."""
    if session in _erased:
        raise Erased(session)


def stop_sending(sessions: Iterable[str]) -> None:
    """Let no more of these sessions go out. A file that is being written for one is not sent either."""
    _erased.update(sessions)
