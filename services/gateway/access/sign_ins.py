"""What a browser holds between signing in and signing out: an id and a secret that is renewed now and then."""

import hashlib
import hmac
import secrets
from datetime import datetime, timedelta
from http import HTTPStatus

from sqlalchemy import delete, or_, select, update
from sqlalchemy.orm import Session

from services.gateway.access.caller import Caller
from services.gateway.access.roles import Role
from services.gateway.access.tables import AccountRow, ShareRow, SignInRow
from services.gateway.audit import records as audit
from services.gateway.audit.chain import Entry
from services.gateway.parameters import GatewayParameters

SEEN_EVERY = timedelta(minutes=1)
"""A row is not written more often than this just because its owner is there."""

MOST = 20
"""Number of browsers that may be signed in to one account."""

OLD_SECRET = "old_sign_in_secret"
"""The audit's word for a cookie that has been copied, as far as one can tell."""


def digest(secret: str) -> str:
    """How a secret is kept: SHA-256 is enough for 256 random bits."""
    return hashlib.sha256(secret.encode()).hexdigest()


def begin(database: Session, account: AccountRow, now: datetime, confirmed: datetime | None = None) -> str:
    """A new sign-in; what goes into the cookie. Past the most of them, those of the account seen longest ago end.

    `confirmed`: when the password was given; None for just now.
    """
    newest_first = select(SignInRow.id).where(SignInRow.account_id == account.id).order_by(SignInRow.seen.desc())
    end(database, *database.scalars(newest_first.offset(MOST - 1)))
    secret = secrets.token_urlsafe(32)
    row = SignInRow(
        id=secrets.token_hex(8), account_id=account.id, secret=digest(secret), former_secret=None,
        renewed=now, created=now, seen=now, confirmed=confirmed or now,
    )  # fmt: skip
    database.add(row)
    return f"{row.id}.{secret}"


def find(database: Session, cookie: str | None, now: datetime, parameters: GatewayParameters) -> SignInRow | None:
    """The sign-in of a cookie; None when there is none, or it has expired.

    An id with any secret but the newest, or the one before it for a short while, comes from a cookie that was copied:
    the thief or the owner has renewed it since. That sign-in ends for both, and the audit has it.
    """
    name, _, secret = (cookie or "").partition(".")
    row = database.get(SignInRow, name) if secret else None
    if row is None or has_expired(row, now, parameters):
        return None
    kept = digest(secret)
    if hmac.compare_digest(row.secret, kept):
        return row
    in_grace = now - row.renewed <= timedelta(seconds=parameters.renewal_grace_s)
    if in_grace and row.former_secret is not None and hmac.compare_digest(row.former_secret, kept):
        return row
    _end_copied(database, row, now)
    return None


def _end_copied(database: Session, row: SignInRow, now: datetime) -> None:
    if not end(database, row.id):
        return
    account = database.get(AccountRow, row.account_id)
    audit.append(
        database,
        Entry(
            at=now, actor_kind="nobody", actor=None, role=None, clinic=account.clinic_id if account else None,
            action=OLD_SECRET, patient=None, session=None, object=f"account={row.account_id}",
            outcome=HTTPStatus.UNAUTHORIZED, reason=None,
        ),
    )  # fmt: skip


def has_expired(row: SignInRow, now: datetime, parameters: GatewayParameters) -> bool:
    """Whether a sign-in is too old, or nobody was there for too long."""
    oldest = timedelta(seconds=parameters.sign_in_most_s)
    idle = timedelta(seconds=parameters.sign_in_idle_s)
    return now - row.created > oldest or now - row.seen > idle


def find_caller(database: Session, cookie: str | None, now: datetime, parameters: GatewayParameters) -> Caller | None:
    """Who holds the cookie."""
    row = find(database, cookie, now, parameters)
    if row is None:
        return None
    if now - row.seen > SEEN_EVERY:
        # Not through the mapped row: it may be ended by another request at this very moment.
        database.execute(update(SignInRow).where(SignInRow.id == row.id).values(seen=now))
    return caller_of(database, row)


def find_again(database: Session, sign_in: str, now: datetime, parameters: GatewayParameters) -> Caller | None:
    """Who holds a sign-in that was found before: a live connection still has the cookie it was opened with."""
    row = database.get(SignInRow, sign_in)
    return None if row is None or has_expired(row, now, parameters) else caller_of(database, row)


def caller_of(database: Session, row: SignInRow) -> Caller | None:
    """The account of a sign-in as it may do things now; None when it is closed."""
    account = database.get(AccountRow, row.account_id)
    if account is None or account.disabled:
        return None
    return Caller(
        "person", account.id, account.login, Role(account.role), account.clinic_id,
        shared_with(database, account.id), row.id, account.site_admin, row.confirmed,
    )  # fmt: skip


def renew(row: SignInRow, now: datetime, parameters: GatewayParameters) -> str | None:
    """A new secret for a sign-in, for the cookie; None while the last renewal is so young that requests with the
    secret before it may still be under way (several tabs renew at once)."""
    row.seen = now
    if row.former_secret is not None and now - row.renewed <= timedelta(seconds=parameters.renewal_grace_s):
        return None
    secret = secrets.token_urlsafe(32)
    row.former_secret, row.secret, row.renewed = row.secret, digest(secret), now
    return f"{row.id}.{secret}"


def end_all(database: Session, account: str, but: str | None = None) -> int:
    """End an account's sign-ins, except one; their number."""
    theirs = database.scalars(select(SignInRow.id).where(SignInRow.account_id == account))
    return end(database, *(name for name in theirs if name != but))


def end(database: Session, *names: str) -> int:
    """End sign-ins; the number of those that another request has not ended meanwhile."""
    return len(list(database.scalars(delete(SignInRow).where(SignInRow.id.in_(names)).returning(SignInRow.id))))


def forget_expired(database: Session, now: datetime, parameters: GatewayParameters) -> int:
    """Remove the sign-ins that have expired; their number."""
    created = now - timedelta(seconds=parameters.sign_in_most_s)
    seen = now - timedelta(seconds=parameters.sign_in_idle_s)
    gone = select(SignInRow.id).where(or_(SignInRow.created < created, SignInRow.seen < seen))
    return end(database, *database.scalars(gone))


def shared_with(database: Session, account: str) -> frozenset[str]:
    """Codes of the patients that were shared with an account."""
    return frozenset(database.scalars(select(ShareRow.patient_code).where(ShareRow.account_id == account)))
