"""Accounts in the database."""

import secrets
from datetime import UTC, datetime

from sqlalchemy import func, select, update
from sqlalchemy.orm import Session

from services.gateway.access.roles import Role
from services.gateway.access.tables import AccountRow
from services.gateway.problems import not_found
from services.gateway.tables import ClinicRow


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


def one_at_a_time(database: Session) -> None:
    """Wait for every other transaction that changes who may do what; what is read from here on stays true.

    A write that changes nothing: of the whole database's lock in SQLite, of these rows' in PostgreSQL.
    """
    database.execute(update(ClinicRow).values(name=ClinicRow.name), execution_options={"synchronize_session": False})


def count_site_admins(database: Session) -> int:
    """Those who can still sign in."""
    open_ones = select(func.count()).where(AccountRow.site_admin.is_(True), AccountRow.disabled.is_(False))
    return database.scalar(open_ones) or 0


def get_account(database: Session, account: str) -> AccountRow:
    """Raises a 404 problem when there is none of that id."""
    row = database.get(AccountRow, account)
    if row is None:
        raise not_found("account", account)
    return row
