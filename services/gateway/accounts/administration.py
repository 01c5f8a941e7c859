"""REST of the accounts of a clinic, for its administrators; of all clinics for those of the site."""

from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Path, Request
from sqlalchemy.orm import Session

from services.gateway.access import sign_ins
from services.gateway.access.identify import Person
from services.gateway.access.roles import Permission, Role
from services.gateway.access.rules import needs
from services.gateway.access.scope import EVERYTHING
from services.gateway.access.tables import AccountRow
from services.gateway.accounts import administering, records
from services.gateway.accounts.account_models import AccountChange, AccountIn, AccountOut, AccountPage, PasswordIn
from services.gateway.accounts.attempts import note_success
from services.gateway.accounts.browser import provider_of
from services.gateway.accounts.routes import refuse_weak
from services.gateway.audit.noting import Noted, note
from services.gateway.context import Limit, Offset, Parts
from services.gateway.problems import Problem, documented
from services.gateway.settings import GatewaySettings

router = APIRouter(prefix="/v1/accounts", tags=["accounts"])

ADMINISTER = [needs(Permission.ADMINISTER)]
REFUSALS = documented(HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND, HTTPStatus.CONFLICT)
AccountId = Annotated[str, Path(pattern="^[0-9a-f]{1,32}$", description="account id", examples=["8d0c2a71f04be655"])]


@router.get("", dependencies=ADMINISTER, responses=documented())
def list_accounts(caller: Person, gateway: Parts, offset: Offset = 0, limit: Limit = 50) -> AccountPage:
    """List the accounts of the clinic, by login; administrators of the site see those of all clinics."""
    with gateway.database.transaction(EVERYTHING) as database:
        total, rows = administering.list_accounts(database, caller, offset, limit)
        return AccountPage(total=total, items=_shape(database, rows, gateway.settings))


@router.post("", status_code=HTTPStatus.CREATED, dependencies=ADMINISTER, responses=REFUSALS)
def create_account(body: AccountIn, caller: Person, request: Request, gateway: Parts) -> AccountOut:
    """Make an account: with a password to hand over, or for somebody who signs in with the organisation's service."""
    kept = None
    if body.password is not None:
        refuse_weak(body.password.get_secret_value(), body.login)
        kept = gateway.passwords.keep(body.password.get_secret_value())
    with gateway.database.transaction(EVERYTHING) as database:
        records.one_at_a_time(database)
        clinic = administering.clinic_for(database, caller, body.clinic)
        if body.site_admin:
            administering.check_site_admin(caller, body.role, body.site_admin)
        if records.find_login(database, body.login) is not None:
            raise Problem(HTTPStatus.CONFLICT, "There is an account of that name.", "Choose another name.")
        row = records.add_account(database, body.login, Role(body.role), clinic, kept, site_admin=body.site_admin)
        row.issuer = _issuer(gateway.settings, body.provider)
        note(request, Noted(object=f"account={row.id} role={row.role} clinic={clinic} site_admin={row.site_admin}"))
        database.flush()
        return _shape(database, [row], gateway.settings)[0]


@router.patch("/{account}", dependencies=ADMINISTER, responses=REFUSALS)
def change_account(
    account: AccountId, body: AccountChange, caller: Person, request: Request, gateway: Parts
) -> AccountOut:
    """Give an account another role or clinic, or close or open it. A closed one is signed out everywhere."""
    wish = body.model_dump(mode="json", exclude_none=True)
    note(request, Noted(object=" ".join(f"{name}={value}" for name, value in wish.items())))
    with gateway.database.transaction(EVERYTHING) as database:
        records.one_at_a_time(database)
        row = administering.get_another(database, caller, account)
        administering.change(database, caller, row, body)
        return _shape(database, [row], gateway.settings)[0]


@router.put("/{account}/password", status_code=HTTPStatus.NO_CONTENT, dependencies=ADMINISTER, responses=REFUSALS)
def set_password(account: AccountId, body: PasswordIn, caller: Person, gateway: Parts) -> None:
    """Give somebody a new password. They are signed out everywhere, and wrong passwords before are forgotten."""
    password = body.password.get_secret_value()
    with gateway.database.transaction(EVERYTHING) as database:
        refuse_weak(password, administering.get_another(database, caller, account).login)
    kept = gateway.passwords.keep(password)
    with gateway.database.transaction(EVERYTHING) as database:
        records.one_at_a_time(database)
        row = administering.get_another(database, caller, account)
        if row.password is None:
            raise Problem(
                HTTPStatus.CONFLICT, "This account signs in elsewhere.", "Its password is changed at that service."
            )
        row.password = kept
        note_success(row)
        sign_ins.end_all(database, row.id)


def _issuer(settings: GatewaySettings, provider: str | None) -> str | None:
    if provider is None:
        return None
    if provider not in settings.oidc:
        raise Problem(
            HTTPStatus.CONFLICT, "There is no such sign-in service.", "GET /v1/sign-in names those that are set up."
        )
    return settings.oidc[provider].issuer


def _shape(database: Session, rows: list[AccountRow], settings: GatewaySettings) -> list[AccountOut]:
    browsers = administering.count_browsers(database, [row.id for row in rows])
    return [
        AccountOut(
            id=row.id,
            login=row.login,
            role=Role(row.role),
            clinic=row.clinic_id,
            site_admin=row.site_admin,
            disabled=row.disabled,
            provider=provider_of(row, settings),
            created=row.created,
            locked_until=row.locked_until,
            browsers=browsers.get(row.id, 0),
        )
        for row in rows
    ]
