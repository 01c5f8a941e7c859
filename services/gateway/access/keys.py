"""Keys of machines: shown once, kept as a digest, with an end."""

import hmac
import secrets
from datetime import datetime, timedelta

from sqlalchemy.orm import Session

from services.gateway.access.caller import Caller
from services.gateway.access.roles import Role
from services.gateway.access.sign_ins import digest
from services.gateway.access.tables import ApiKeyRow

PREFIX = "ambula"
USED_EVERY = timedelta(minutes=1)


def add_key(
    database: Session, name: str, role: Role, clinic: str, by: str | None, now: datetime, days: int
) -> tuple[ApiKeyRow, str]:
    """A new key, and its text, which is not kept."""
    secret = secrets.token_urlsafe(32)
    row = ApiKeyRow(
        id=secrets.token_hex(6), name=name, secret=digest(secret), role=role, clinic_id=clinic, created_by=by,
        created=now, expires=now + timedelta(days=days), used=None, revoked=None,
    )  # fmt: skip
    database.add(row)
    return row, f"{PREFIX}_{row.id}_{secret}"


def find_caller(database: Session, key: str, now: datetime) -> Caller | None:
    """Whose key it is; None when it is not one, has ended or was taken back."""
    prefix, _, rest = key.partition("_")
    name, _, secret = rest.partition("_")
    row = database.get(ApiKeyRow, name) if prefix == PREFIX and secret else None
    if row is None or not hmac.compare_digest(row.secret, digest(secret)):
        return None
    if row.revoked is not None or now >= row.expires:
        return None
    if row.used is None or now - row.used > USED_EVERY:
        row.used = now
    return Caller("machine", row.id, row.name, Role(row.role), row.clinic_id)
