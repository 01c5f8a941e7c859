"""Who is asking."""

from dataclasses import dataclass
from datetime import datetime
from typing import Literal

from services.gateway.access.roles import MAY, Permission, Role
from services.gateway.access.scope import Scope


@dataclass(frozen=True, slots=True)
class Caller:
    """A person who has signed in, or a machine with a key.

    `account`: id of the account or the key; `login`: the name it is known by; `sign_in`: id of the browser's sign-in,
    None for a machine; `site_admin`: may manage every clinic of the site (its accounts, not its patients);
    `confirmed`: when the password was last given.
    """

    kind: Literal["person", "machine"]
    account: str
    login: str
    role: Role
    clinic: str
    shared: frozenset[str] = frozenset()
    sign_in: str | None = None
    site_admin: bool = False
    confirmed: datetime | None = None

    @property
    def scope(self) -> Scope:
        """What of the database exists for this caller."""
        return Scope(self.clinic, self.shared)

    @property
    def bin(self) -> Scope:
        """What the caller's clinic has deleted."""
        return Scope(self.clinic, in_bin=True)

    def may(self, permission: Permission) -> bool:
        """Whether the role has the permission."""
        return self.role in MAY[permission]
