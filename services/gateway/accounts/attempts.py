"""Trying a password: counted before it is looked at, so that no number of guesses at once gets around the lock-out."""

from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

from sqlalchemy import or_, update
from sqlalchemy.orm import Session

from services.gateway.access.scope import EVERYTHING
from services.gateway.access.tables import AccountRow
from services.gateway.accounts import records
from services.gateway.context import Gateway
from services.gateway.parameters import GatewayParameters

MOST_DOUBLINGS = 20


@dataclass
class Attempt:
    """One try. `account`: id of the account it was for, None when there is none of that name."""

    login: str
    password: str
    account: str | None = None
    kept: str | None = None

    def fits(self, gateway: Gateway) -> bool:
        """Whether it is the password of an account that is open. Takes as long where it is not.

        Raises TooManyPasswords.
        """
        return gateway.passwords.fits(lambda: self._count(gateway), self.password)

    def _count(self, gateway: Gateway) -> str | None:
        with gateway.database.transaction(EVERYTHING) as database:
            account = records.find_login(database, self.login)
            if account is None:
                return None
            self.account = account.id
            if count_attempt(database, account, datetime.now(UTC), gateway.parameters):
                self.kept = account.password
        return self.kept

    def succeed(self, database: Session) -> AccountRow | None:
        """Forget what was wrong before; the account, None when it was closed or changed meanwhile."""
        account = database.get(AccountRow, self.account)
        if account is None or account.disabled or account.password != self.kept:
            return None
        note_success(account)
        return account


def count_attempt(database: Session, account: AccountRow, now: datetime, parameters: GatewayParameters) -> bool:
    """Count a try as wrong until it is known to be right; False when the account is closed.

    After some of them the account closes, each time for twice as long.
    """
    is_open = or_(AccountRow.locked_until.is_(None), AccountRow.locked_until <= now)
    counting = (
        update(AccountRow)
        .where(AccountRow.id == account.id, AccountRow.disabled.is_(False), AccountRow.password.is_not(None), is_open)
        .values(failures=AccountRow.failures + 1)
        .returning(AccountRow.failures)
    )
    failures = database.scalar(counting, execution_options={"synchronize_session": False})
    if failures is None:
        return False
    database.refresh(account)
    over = failures - parameters.free_failures - 1
    if over >= 0:
        wait_s = min(parameters.first_lock_s * 2.0 ** min(over, MOST_DOUBLINGS), parameters.longest_lock_s)
        account.locked_until = now + timedelta(seconds=wait_s)
    return True


def note_success(account: AccountRow) -> None:
    """The right password: what was wrong before is forgotten."""
    account.failures, account.locked_until = 0, None
