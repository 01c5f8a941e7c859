"""What comes off the bus, and the grip on what was declared on it."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Received:
    """One message or answer: the payload with what travelled beside it."""

    key: str
    attachment: bytes
    payload: bytes


class Handle:
    """Something declared on the bus; `close` takes it back, once."""

    def __init__(self, undeclare: Callable[[], None]) -> None:
        self._undeclare: Callable[[], None] | None = undeclare

    @property
    def closed(self) -> bool:
        """It was taken back."""
        return self._undeclare is None

    def close(self) -> None:
        """Take it back. May be called again."""
        undeclare, self._undeclare = self._undeclare, None
        if undeclare is not None:
            undeclare()
