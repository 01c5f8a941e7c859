"""Handing a sign-in to a browser, and telling it whose it is."""

from datetime import UTC, datetime

from fastapi import Request, Response
from sqlalchemy.orm import Session

from services.gateway.access import sign_ins
from services.gateway.access.caller import Caller
from services.gateway.access.identify import cookie_name, is_secure
from services.gateway.access.roles import Permission
from services.gateway.access.tables import AccountRow
from services.gateway.accounts.models import MeOut
from services.gateway.context import Gateway
from services.gateway.settings import GatewaySettings
from services.gateway.tables import ClinicRow


def begin_sign_in(
    database: Session, account: AccountRow, request: Request, response: Response, confirmed: datetime | None = None
) -> Caller:
    """Sign in to an account: the cookie goes with the response, and the audit knows who it is from here on.

    `confirmed`: when the password was given; None for just now.
    """
    gateway: Gateway = request.app.state.gateway
    now = datetime.now(UTC)
    cookie = sign_ins.begin(database, account, now, confirmed)
    database.flush()
    caller = sign_ins.find_caller(database, cookie, now, gateway.parameters)
    assert caller is not None
    request.state.caller = caller
    give_cookie(request, response, cookie)
    return caller


def give_cookie(request: Request, response: Response, cookie: str) -> None:
    """Have the browser hold a sign-in."""
    # Without a lifetime of its own it goes with the browser; the gateway decides when it ends before that.
    response.set_cookie(
        cookie_name(request), cookie, path="/", httponly=True, samesite="strict", secure=is_secure(request)
    )


def take_cookie(request: Request, response: Response) -> None:
    """Have the browser forget it."""
    response.delete_cookie(cookie_name(request), path="/", httponly=True, samesite="strict", secure=is_secure(request))


def me(database: Session, caller: Caller, settings: GatewaySettings) -> MeOut:
    """The caller as a page needs it."""
    clinic = database.get_one(ClinicRow, caller.clinic)
    account = database.get(AccountRow, caller.account) if caller.kind == "person" else None
    return MeOut(
        account=caller.account,
        login=caller.login,
        role=caller.role,
        clinic=clinic.id,
        clinic_name=clinic.name,
        site_admin=caller.site_admin,
        provider=None if account is None else provider_of(account, settings),
        may=[permission for permission in Permission if caller.may(permission)],
    )


def provider_of(account: AccountRow, settings: GatewaySettings) -> str | None:
    """Name of the service where an account signs in; its issuer when it is not set up any more, None for a password."""
    if account.issuer is None:
        return None
    names = (name for name, provider in settings.oidc.items() if provider.issuer == account.issuer)
    return next(names, account.issuer)
