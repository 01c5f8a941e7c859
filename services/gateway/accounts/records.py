"""Accounts in the database, and who may sign in."""

import secrets
from datetime import UTC, datetime, timedelta

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from services.gateway.access.roles import Role
from services.gateway.access.tables import AccountRow
from services.gateway.parameters import GatewayParameters


def add_account(
    database: Session, login: str, role: Role, clinic: str, password: str | None, *, site_admin: bool = False
) -> AccountRow:
    """Store a new account; `password` as it is kept, None for one that signs in elsewhere."""
    row = AccountRow(
        id=secrets.token_hex(8), login=login, role=role, clinic_id=clinic, site_admin=site_admin, password=password,
        issuer=None, subject=None, disabled=False, created=datetime.now(UTC), failures=0, locked_until=None,
    )  # fmt: skip
    database.add(row)
    return row


def find_login(database: Session, login: str) -> AccountRow | None:
    """The account of that name, however it is written."""
    return database.scalar(select(AccountRow).where(func.lower(AccountRow.login) == login.lower()))


def has_accounts(database: Session) -> bool:
    """Whether anybody has an account yet."""
    return bool(database.scalar(select(func.count()).select_from(AccountRow)))


def is_locked(account: AccountRow, now: datetime) -> bool:
    """Whether wrong passwords have closed the account for a while."""
    return account.locked_until is not None and now < account.locked_until


def note_failure(account: AccountRow, now: datetime, parameters: GatewayParameters) -> None:
    """One more wrong password: after some of them the account closes, each time for twice as long."""
    account.failures += 1
    over = account.failures - parameters.free_failures
    if over >= 0:
        wait_s = min(parameters.first_lock_s * 2.0**over, parameters.longest_lock_s)
        account.locked_until = now + timedelta(seconds=wait_s)


def note_success(account: AccountRow) -> None:
    """The right password: what was wrong before is forgotten."""
    account.failures, account.locked_until = 0, None
