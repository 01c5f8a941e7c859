"""REST of shared patients. Whoever works with a patient in their own clinic says with whom they are shared."""

from datetime import UTC, datetime
from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Depends, Path, Query, Request
from sqlalchemy import select
from sqlalchemy.orm import Session

from services.gateway.access.identify import Person, person
from services.gateway.access.roles import Role
from services.gateway.access.rules import WORK
from services.gateway.access.statements import OutOfScope
from services.gateway.access.tables import AccountRow, ShareRow
from services.gateway.accounts.records import find_login, one_at_a_time
from services.gateway.audit.noting import Noted, note
from services.gateway.context import Context, Gateway, PatientCode
from services.gateway.patients.records import get_patient
from services.gateway.problems import Problem, documented, not_found
from services.gateway.sharing.models import ColleagueOut, ShareIn, ShareOut, SharesOut
from services.gateway.tables import ClinicRow

router = APIRouter(prefix="/v1", tags=["sharing"])

MOST_SHARES = 50
"""Colleagues who may see one patient."""

SHARE = [*WORK, Depends(person)]
REFUSALS = documented(HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT)
FIND_COLLEAGUE = "Find them by their exact name to sign in with: GET /v1/colleagues?login=..."
ColleagueId = Annotated[str, Path(pattern="^[0-9a-f]{1,32}$", description="account id", examples=["8d0c2a71f04be655"])]


@router.get("/colleagues", dependencies=SHARE, responses=documented(HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND))
def find_colleague(
    caller: Person,
    gateway: Context,
    login: Annotated[
        str, Query(max_length=64, pattern=r"^[^\x00-\x1f]+$", description="the whole name to sign in with")
    ],
) -> ColleagueOut:
    """Find a colleague of any clinic by the exact name they sign in with. There is no list of them."""
    with gateway.transaction() as database:
        row = find_login(database, login)
        if row is None or row.disabled or row.id == caller.account:
            raise _nobody()
        return _colleague(database, row)


@router.get("/patients/{code}/shares", dependencies=SHARE, responses=REFUSALS)
def list_shares(code: PatientCode, gateway: Context) -> SharesOut:
    """Everybody outside of the clinic who may see the patient."""
    with gateway.transaction() as database:
        return SharesOut(items=[_shape(database, row) for row in _shares(database, gateway, code)])


@router.post("/patients/{code}/shares", status_code=HTTPStatus.CREATED, dependencies=SHARE, responses=REFUSALS)
def share_patient(code: PatientCode, body: ShareIn, caller: Person, request: Request, gateway: Context) -> ShareOut:
    """Let a colleague of another clinic see a patient of one's own, and start sessions with them. Twice is once."""
    note(request, Noted(object=f"account={body.account}"))
    with gateway.transaction() as database:
        one_at_a_time(database)
        shares = {row.account_id: row for row in _shares(database, gateway, code)}
        colleague = database.get(AccountRow, body.account)
        if colleague is None or colleague.disabled:
            raise _nobody()
        if colleague.clinic_id == caller.clinic:
            raise Problem(
                HTTPStatus.CONFLICT, "They work in this clinic and see the patient.", "Nothing is left to do."
            )
        if colleague.id not in shares and len(shares) >= MOST_SHARES:
            raise Problem(HTTPStatus.CONFLICT, "Too many colleagues see this patient.", "End another share before.")
        row = shares.get(colleague.id) or ShareRow(
            patient_code=code, account_id=colleague.id, granted_by=caller.account, granted=datetime.now(UTC)
        )
        database.add(row)
        database.flush()
        return _shape(database, row)


@router.delete(
    "/patients/{code}/shares/{account}", status_code=HTTPStatus.NO_CONTENT, dependencies=SHARE, responses=REFUSALS
)
def end_share(code: PatientCode, account: ColleagueId, gateway: Context) -> None:
    """End a share: the colleague does not see the patient any more, on open pages within seconds."""
    with gateway.transaction() as database:
        row = next((share for share in _shares(database, gateway, code) if share.account_id == account), None)
        if row is None:
            raise not_found("share", account)
        database.delete(row)


def _shares(database: Session, gateway: Gateway, code: str) -> list[ShareRow]:
    """Raises a 404 problem when the patient does not exist here, OutOfScope when it is another clinic's."""
    if get_patient(database, code).clinic_id != gateway.known_caller.clinic:
        raise OutOfScope("a shared patient is shared by their own clinic alone")
    order = select(ShareRow).where(ShareRow.patient_code == code).order_by(ShareRow.granted, ShareRow.account_id)
    return list(database.scalars(order))


def _nobody() -> Problem:
    return Problem(HTTPStatus.NOT_FOUND, "Nobody of that name has an account.", FIND_COLLEAGUE)


def _colleague(database: Session, row: AccountRow) -> ColleagueOut:
    return ColleagueOut(
        account=row.id,
        login=row.login,
        role=Role(row.role),
        clinic=row.clinic_id,
        clinic_name=database.get_one(ClinicRow, row.clinic_id).name,
    )


def _shape(database: Session, row: ShareRow) -> ShareOut:
    by = database.get(AccountRow, row.granted_by) if row.granted_by is not None else None
    return ShareOut(
        **_colleague(database, database.get_one(AccountRow, row.account_id)).model_dump(),
        granted=row.granted,
        granted_by=None if by is None else by.login,
    )
