"""Passwords, kept with argon2id."""

import threading
from functools import cached_property

from argon2 import PasswordHasher
from argon2.exceptions import InvalidHashError, VerifyMismatchError

SHORTEST = 12
"""Letters; long enough that guessing through the lock-out is hopeless (NIST SP 800-63B asks for 8 with a second
factor, 15 without)."""

MOST_AT_ONCE = 2
"""Each takes about 0.1 s and 64 MiB: more at once would be a way to stop the gateway."""


class Passwords:
    """Hashes and verifies in whichever thread asks, a bounded number at a time."""

    def __init__(self, hasher: PasswordHasher | None = None) -> None:
        self._hasher = hasher or PasswordHasher(time_cost=3, memory_cost=64 * 1024, parallelism=4)
        self._places = threading.BoundedSemaphore(MOST_AT_ONCE)

    @cached_property
    def _nobodys(self) -> str:
        return self._hasher.hash("nobody's password")

    def keep(self, password: str) -> str:
        """What the database holds of a password."""
        with self._places:
            return self._hasher.hash(password)

    def fits(self, kept: str | None, password: str) -> bool:
        """Whether it is the password. Without one to compare with, as much time goes by as with one."""
        with self._places:
            try:
                return self._hasher.verify(kept or self._nobodys, password) and kept is not None
            except (VerifyMismatchError, InvalidHashError):
                return False
