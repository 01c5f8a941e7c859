"""Whose account it is that a sign-in service vouches for."""

import re

from sqlalchemy import select
from sqlalchemy.orm import Session

from services.gateway.access.tables import AccountRow
from services.gateway.accounts.oidc.settings import OidcProvider
from services.gateway.accounts.oidc.tokens import Claims
from services.gateway.accounts.records import add_account, find_login, one_at_a_time
from services.gateway.tables import ClinicRow

LOGIN = re.compile(r"[A-Za-z0-9][A-Za-z0-9._@-]{0,63}")
LONGEST_SUBJECT = 200


def account_of(database: Session, provider: OidcProvider, claims: Claims) -> AccountRow | None:
    """The account that was linked before; one that was made for this service and nobody has used; or a new one, where
    the site wants that. None when there is none, or it is closed.

    An account with a password of its own is never taken over, whatever the service says its owner is called.
    """
    if not claims.subject or len(claims.subject) > LONGEST_SUBJECT:
        return None
    one_at_a_time(database)
    linked = database.scalar(
        select(AccountRow).where(AccountRow.issuer == provider.issuer, AccountRow.subject == claims.subject)
    )
    account = linked or _unused(database, provider, claims.login) or _made(database, provider, claims.login)
    if account is None or account.disabled:
        return None
    account.subject = claims.subject
    return account


def _unused(database: Session, provider: OidcProvider, login: str | None) -> AccountRow | None:
    account = find_login(database, login) if login is not None else None
    waits = account is not None and account.password is None and account.subject is None
    return account if account is not None and waits and account.issuer == provider.issuer else None


def _made(database: Session, provider: OidcProvider, login: str | None) -> AccountRow | None:
    if provider.role is None or provider.clinic is None or login is None or LOGIN.fullmatch(login) is None:
        return None
    if find_login(database, login) is not None or database.get(ClinicRow, provider.clinic) is None:
        return None
    account = add_account(database, login, provider.role, provider.clinic, None)
    account.issuer = provider.issuer
    return account
