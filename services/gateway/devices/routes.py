"""REST of devices."""

import secrets
from datetime import UTC, datetime
from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Path, Request
from sqlalchemy import func, select

from services.gateway.access.roles import Permission
from services.gateway.access.rules import READ, needs
from services.gateway.access.scope import EVERYTHING
from services.gateway.access.tables import DeviceRow
from services.gateway.accounts.records import one_at_a_time
from services.gateway.audit.noting import Noted, note
from services.gateway.context import Context, Limit, Offset
from services.gateway.devices.models import DeviceChange, DeviceIn, DeviceOut, DevicePage
from services.gateway.devices.records import check_free
from services.gateway.problems import documented, not_found

router = APIRouter(prefix="/v1/devices", tags=["devices"])

ADMINISTER = [needs(Permission.ADMINISTER)]
DeviceId = Annotated[str, Path(pattern="^[0-9a-f]{1,32}$", description="device id", examples=["5b1e9a20c4d7"])]


@router.get("", dependencies=READ, responses=documented())
def list_devices(gateway: Context, offset: Offset = 0, limit: Limit = 50) -> DevicePage:
    """List the clinic's devices: those in use by name, then the others."""
    ours = DeviceRow.clinic_id == gateway.known_caller.clinic
    with gateway.database.transaction(EVERYTHING) as database:
        total = database.scalar(select(func.count()).select_from(DeviceRow).where(ours)) or 0
        order = select(DeviceRow).where(ours)
        order = order.order_by(DeviceRow.retired.is_not(None), DeviceRow.name, DeviceRow.id)
        items = [_shape(row) for row in database.scalars(order.offset(offset).limit(limit))]
    return DevicePage(total=total, items=items)


@router.post("", status_code=HTTPStatus.CREATED, dependencies=ADMINISTER, responses=documented(HTTPStatus.CONFLICT))
def create_device(body: DeviceIn, request: Request, gateway: Context) -> DeviceOut:
    """Register a device of the clinic. A source that is registered is offered to no other clinic."""
    with gateway.database.transaction(EVERYTHING) as database:
        one_at_a_time(database)
        check_free(database, body.source, None)
        row = DeviceRow(
            id=secrets.token_hex(6), clinic_id=gateway.known_caller.clinic, retired=None, created=datetime.now(UTC),
            **body.model_dump(),
        )  # fmt: skip
        database.add(row)
        note(request, Noted(object=f"device={row.id}"))
        return _shape(row)


@router.patch("/{device}", dependencies=ADMINISTER, responses=documented(HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT))
def change_device(device: DeviceId, body: DeviceChange, gateway: Context) -> DeviceOut:
    """Correct what is known of a device, or retire it."""
    with gateway.database.transaction(EVERYTHING) as database:
        one_at_a_time(database)
        row = database.get(DeviceRow, device)
        if row is None or row.clinic_id != gateway.known_caller.clinic:
            raise not_found("device", device)
        for name, value in body.model_dump(exclude_unset=True, exclude={"retired"}).items():
            setattr(row, name, value)
        if "retired" in body.model_fields_set:
            row.retired = (row.retired or datetime.now(UTC)) if body.retired else None
        if row.retired is None:
            check_free(database, row.source, row.id)
        return _shape(row)


def _shape(row: DeviceRow) -> DeviceOut:
    return DeviceOut(
        id=row.id,
        name=row.name,
        kind=row.kind,
        source=row.source,
        note=row.note,
        retired=row.retired,
        created=row.created,
    )
