"""REST of the keys of machines."""

from datetime import UTC, datetime
from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Path, Request
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from services.gateway.access.identify import Person
from services.gateway.access.keys import add_key
from services.gateway.access.roles import Permission, Role
from services.gateway.access.rules import needs
from services.gateway.access.scope import EVERYTHING
from services.gateway.access.tables import AccountRow, ApiKeyRow
from services.gateway.audit.noting import Noted, note
from services.gateway.context import Limit, Offset, Parts
from services.gateway.keys.models import KeyIn, KeyOut, KeyPage, NewKeyOut
from services.gateway.problems import documented, not_found

router = APIRouter(prefix="/v1/keys", tags=["keys"])

ADMINISTER = [needs(Permission.ADMINISTER)]
KeyId = Annotated[str, Path(pattern="^[0-9a-f]{1,32}$", description="key id", examples=["3f9c0a71be42"])]


@router.get("", dependencies=ADMINISTER, responses=documented())
def list_keys(caller: Person, gateway: Parts, offset: Offset = 0, limit: Limit = 50) -> KeyPage:
    """List the clinic's keys, newest first, those that have ended included."""
    ours = ApiKeyRow.clinic_id == caller.clinic
    with gateway.database.transaction(EVERYTHING) as database:
        total = database.scalar(select(func.count()).select_from(ApiKeyRow).where(ours)) or 0
        order = select(ApiKeyRow).where(ours).order_by(ApiKeyRow.created.desc(), ApiKeyRow.id)
        rows = list(database.scalars(order.offset(offset).limit(limit)))
        return KeyPage(total=total, items=[_shape(database, row) for row in rows])


@router.post("", status_code=HTTPStatus.CREATED, dependencies=ADMINISTER, responses=documented(HTTPStatus.FORBIDDEN))
def create_key(body: KeyIn, caller: Person, request: Request, gateway: Parts) -> NewKeyOut:
    """Make a key for a machine of the clinic. Its text is in this answer and nowhere else."""
    now = datetime.now(UTC)
    with gateway.database.transaction(EVERYTHING) as database:
        row, text = add_key(database, body.name, Role(body.role), caller.clinic, caller.account, now, body.days)
        database.flush()
        note(request, Noted(object=f"key={row.id} role={row.role} days={body.days}"))
        return NewKeyOut(**_shape(database, row).model_dump(), key=text)


@router.delete(
    "/{key}",
    status_code=HTTPStatus.NO_CONTENT,
    dependencies=ADMINISTER,
    responses=documented(HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND),
)
def revoke_key(key: KeyId, caller: Person, gateway: Parts) -> None:
    """Take a key back; from now on nobody is known by it. It stays in the list."""
    with gateway.database.transaction(EVERYTHING) as database:
        row = database.get(ApiKeyRow, key)
        if row is None or row.clinic_id != caller.clinic:
            raise not_found("key", key)
        row.revoked = row.revoked or datetime.now(UTC)


def _shape(database: Session, row: ApiKeyRow) -> KeyOut:
    maker = database.get(AccountRow, row.created_by) if row.created_by is not None else None
    return KeyOut(
        id=row.id,
        name=row.name,
        role=Role(row.role),
        created_by=None if maker is None else maker.login,
        created=row.created,
        expires=row.expires,
        used=row.used,
        revoked=row.revoked,
    )
