"""What a browser holds between signing in and signing out: an id and a secret that is renewed now and then."""

import hashlib
import hmac
import secrets
from datetime import datetime, timedelta

from sqlalchemy import select
from sqlalchemy.orm import Session

from services.gateway.access.caller import Caller
from services.gateway.access.roles import Role
from services.gateway.access.tables import AccountRow, ShareRow, SignInRow
from services.gateway.parameters import GatewayParameters

SEEN_EVERY = timedelta(minutes=1)
"""A row is not written more often than this just because its owner is there."""


def digest(secret: str) -> str:
    """How a secret is kept: SHA-256 is enough for 256 random bits."""
    return hashlib.sha256(secret.encode()).hexdigest()


def begin(database: Session, account: AccountRow, now: datetime) -> str:
    """A new sign-in; what goes into the cookie."""
    secret = secrets.token_urlsafe(32)
    row = SignInRow(
        id=secrets.token_hex(8), account_id=account.id, secret=digest(secret), former_secret=None,
        renewed=now, created=now, seen=now, confirmed=now,
    )  # fmt: skip
    database.add(row)
    return f"{row.id}.{secret}"


def find(database: Session, cookie: str | None, now: datetime, parameters: GatewayParameters) -> SignInRow | None:
    """The sign-in of a cookie; None when there is none, or it has expired.

    A secret that was renewed longer ago than a page load takes has been copied: that sign-in ends for everybody.
    """
    name, _, secret = (cookie or "").partition(".")
    row = database.get(SignInRow, name) if secret else None
    if row is None:
        return None
    oldest = timedelta(seconds=parameters.sign_in_most_s)
    idle = timedelta(seconds=parameters.sign_in_idle_s)
    if now - row.created > oldest or now - row.seen > idle:
        return None
    kept = digest(secret)
    if hmac.compare_digest(row.secret, kept):
        return row
    if row.former_secret is None or not hmac.compare_digest(row.former_secret, kept):
        return None
    if now - row.renewed <= timedelta(seconds=parameters.renewal_grace_s):
        return row
    database.delete(row)
    return None


def find_caller(database: Session, cookie: str | None, now: datetime, parameters: GatewayParameters) -> Caller | None:
    """Who holds the cookie."""
    row = find(database, cookie, now, parameters)
    account = None if row is None else database.get(AccountRow, row.account_id)
    if row is None or account is None or account.disabled:
        return None
    if now - row.seen > SEEN_EVERY:
        row.seen = now
    return Caller(
        "person", account.id, account.login, Role(account.role), account.clinic_id,
        shared_with(database, account.id), row.id, account.site_admin,
    )  # fmt: skip


def renew(row: SignInRow, now: datetime) -> str:
    """A new secret for a sign-in; what goes into the cookie."""
    secret = secrets.token_urlsafe(32)
    row.former_secret, row.secret, row.renewed, row.seen = row.secret, digest(secret), now, now
    return f"{row.id}.{secret}"


def shared_with(database: Session, account: str) -> frozenset[str]:
    """Codes of the patients that were shared with an account."""
    return frozenset(database.scalars(select(ShareRow.patient_code).where(ShareRow.account_id == account)))
