"""REST of clinics."""

from datetime import UTC, datetime
from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Path, Request
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from services.gateway.access.identify import Person
from services.gateway.access.roles import Permission
from services.gateway.access.rules import needs
from services.gateway.access.scope import EVERYTHING
from services.gateway.access.tables import AccountRow
from services.gateway.accounts.administering import OnlySiteAdmins
from services.gateway.accounts.records import one_at_a_time
from services.gateway.audit.noting import Noted, note
from services.gateway.clinics.models import ClinicChange, ClinicIn, ClinicOut, ClinicPage
from services.gateway.context import Limit, Offset, Parts
from services.gateway.problems import Problem, documented, not_found
from services.gateway.tables import ClinicRow

router = APIRouter(prefix="/v1/clinics", tags=["clinics"])

ADMINISTER = [needs(Permission.ADMINISTER)]
ClinicInPath = Annotated[str, Path(pattern=r"^[a-z0-9][a-z0-9-]{0,31}$", description="clinic id", examples=["main"])]


@router.get("", dependencies=ADMINISTER, responses=documented())
def list_clinics(caller: Person, gateway: Parts, offset: Offset = 0, limit: Limit = 50) -> ClinicPage:
    """List the clinics that the caller manages: one's own, or all of the site."""
    where = [] if caller.site_admin else [ClinicRow.id == caller.clinic]
    with gateway.database.transaction(EVERYTHING) as database:
        total = database.scalar(select(func.count()).select_from(ClinicRow).where(*where)) or 0
        order = select(ClinicRow).where(*where).order_by(ClinicRow.name, ClinicRow.id)
        rows = list(database.scalars(order.offset(offset).limit(limit)))
        return ClinicPage(total=total, items=_shape(database, rows))


@router.post(
    "",
    status_code=HTTPStatus.CREATED,
    dependencies=ADMINISTER,
    responses=documented(HTTPStatus.FORBIDDEN, HTTPStatus.CONFLICT),
)
def create_clinic(body: ClinicIn, caller: Person, request: Request, gateway: Parts) -> ClinicOut:
    """Add a clinic to the site; for administrators of the site."""
    note(request, Noted(object=f"clinic={body.id} keep_days={body.keep_days}"))
    if not caller.site_admin:
        raise OnlySiteAdmins
    with gateway.database.transaction(EVERYTHING) as database:
        one_at_a_time(database)
        if database.get(ClinicRow, body.id) is not None:
            raise Problem(HTTPStatus.CONFLICT, "There is a clinic of that id.", "Choose another id.")
        row = ClinicRow(created=datetime.now(UTC), **body.model_dump())
        database.add(row)
        database.flush()
        return _shape(database, [row])[0]


@router.patch("/{clinic}", dependencies=ADMINISTER, responses=documented(HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND))
def change_clinic(
    clinic: ClinicInPath, body: ClinicChange, caller: Person, request: Request, gateway: Parts
) -> ClinicOut:
    """Name a clinic, or say how long it keeps recordings. What is past that is removed by the next housekeeping."""
    if "keep_days" in body.model_fields_set:
        note(request, Noted(object=f"keep_days={body.keep_days}"))
    with gateway.database.transaction(EVERYTHING) as database:
        row = database.get(ClinicRow, clinic)
        if row is None or not (caller.site_admin or clinic == caller.clinic):
            raise not_found("clinic", clinic)
        for name, value in body.model_dump(exclude_unset=True).items():
            setattr(row, name, value)
        return _shape(database, [row])[0]


def _shape(database: Session, rows: list[ClinicRow]) -> list[ClinicOut]:
    open_ones = (
        select(AccountRow.clinic_id, func.count())
        .where(AccountRow.clinic_id.in_([row.id for row in rows]), AccountRow.disabled.is_(False))
        .group_by(AccountRow.clinic_id)
    )
    counts = {row[0]: row[1] for row in database.execute(open_ones)}
    return [
        ClinicOut(
            id=row.id, name=row.name, keep_days=row.keep_days, created=row.created, accounts=counts.get(row.id, 0)
        )
        for row in rows
    ]
