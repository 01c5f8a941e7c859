"""Passwords, kept with argon2id."""

import base64
import secrets
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http import HTTPStatus

from argon2 import PasswordHasher
from argon2.exceptions import InvalidHashError, VerifyMismatchError

from services.gateway.problems import Problem

SHORTEST = 12
"""Letters; long enough that guessing through the lock-out is hopeless (NIST SP 800-63B asks for 8 with a second
factor, 15 without)."""

FEWEST_DIFFERENT = 5
"""Different letters in a password; fewer are a key that was held down."""

MOST_AT_ONCE = 2
"""Each takes about 0.1 s and 64 MiB: more at once would be a way to stop the gateway."""

MOST_WAITING = 8
"""More would hold the threads that everybody else's requests need."""


class TooManyPasswords(Problem):
    """So many sign in just now that nobody else would be answered."""

    def __init__(self) -> None:
        super().__init__(HTTPStatus.SERVICE_UNAVAILABLE, "Too many sign in at once.", "Try again in a few seconds.")


class Passwords:
    """Hashes and verifies in whichever thread asks, a bounded number at a time, few waiting."""

    def __init__(self, hasher: PasswordHasher | None = None) -> None:
        self._hasher = hasher or PasswordHasher(time_cost=3, memory_cost=64 * 1024, parallelism=4)
        self._places = threading.BoundedSemaphore(MOST_AT_ONCE)
        self._line = threading.BoundedSemaphore(MOST_AT_ONCE + MOST_WAITING)
        self._nobodys = _hash_of_nobody(self._hasher)

    def keep(self, password: str) -> str:
        """What the database holds of a password. Raises TooManyPasswords."""
        with self._turn():
            return self._hasher.hash(_bytes(password))

    def fits(self, find_kept: Callable[[], str | None], password: str) -> bool:
        """Whether it is the password that `find_kept`, called when it is this one's turn, finds in the database.

        Where that finds none, as much is computed as where it does. Raises TooManyPasswords.
        """
        with self._turn():
            kept = find_kept()
            try:
                return self._hasher.verify(kept or self._nobodys, _bytes(password)) and kept is not None
            except (VerifyMismatchError, InvalidHashError):
                return False

    @contextmanager
    def _turn(self) -> Iterator[None]:
        if not self._line.acquire(blocking=False):
            raise TooManyPasswords
        try:
            with self._places:
                yield
        finally:
            self._line.release()


def weakness(password: str, login: str) -> str | None:
    """What makes a password easy to guess; None when nothing obvious does."""
    if login.lower() in password.lower():
        return "it contains the name to sign in with"
    if len(set(password)) < FEWEST_DIFFERENT:
        return f"it has fewer than {FEWEST_DIFFERENT} different letters"
    return None


def _bytes(password: str) -> bytes:
    # JSON can carry halves of characters, which are no text; as a password they are as good as anything.
    return password.encode("utf-8", "surrogatepass")


def _hash_of_nobody(hasher: PasswordHasher) -> str:
    # Random bytes in the form of a hash: nothing has to be computed first, and no password fits.
    salt, tag = (
        base64.b64encode(secrets.token_bytes(length)).decode().rstrip("=")
        for length in (hasher.salt_len, hasher.hash_len)
    )
    cost = f"m={hasher.memory_cost},t={hasher.time_cost},p={hasher.parallelism}"
    return f"$argon2id$v=19${cost}${salt}${tag}"
