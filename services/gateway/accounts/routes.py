"""REST of signing in and out."""

from datetime import UTC, datetime
from http import HTTPStatus

from fastapi import APIRouter, Request, Response
from sqlalchemy.orm import Session

from services.gateway.access import sign_ins
from services.gateway.access.caller import Caller
from services.gateway.access.identify import Identified, NotKnown, cookie_name, cookie_of
from services.gateway.access.roles import Permission, Role
from services.gateway.access.rules import KNOWN, OPEN_TO_ALL
from services.gateway.access.scope import EVERYTHING
from services.gateway.access.tables import AccountRow, SignInRow
from services.gateway.accounts import first_run, records
from services.gateway.accounts.models import FirstRunIn, MeOut, SignInIn, SignInState
from services.gateway.context import Gateway, Parts
from services.gateway.problems import Problem, documented
from services.gateway.tables import ClinicRow

router = APIRouter(prefix="/v1", tags=["accounts"])

WRONG = "The name or the password is wrong, or the account is closed for a while."
TRY_AGAIN = "Try again; after several wrong passwords an account closes for a minute, then longer."


@router.get("/sign-in", dependencies=OPEN_TO_ALL, responses=documented())
def read_sign_in_state(gateway: Parts) -> SignInState:
    """How one can sign in here."""
    with gateway.database.transaction(EVERYTHING) as database:
        return SignInState(first_run=not records.has_accounts(database), providers=[])


@router.post(
    "/first-run",
    status_code=HTTPStatus.CREATED,
    dependencies=OPEN_TO_ALL,
    responses=documented(HTTPStatus.CONFLICT, HTTPStatus.FORBIDDEN),
)
def create_first_administrator(body: FirstRunIn, request: Request, response: Response, gateway: Parts) -> MeOut:
    """Create the first account, an administrator of the whole site, and sign in. Works once."""
    kept = gateway.passwords.keep(body.password.get_secret_value())
    with gateway.database.transaction(EVERYTHING) as database:
        if records.has_accounts(database):
            raise Problem(HTTPStatus.CONFLICT, "There are accounts already.", "Sign in, or ask an administrator.")
        if not first_run.is_code(gateway.settings.data_dir, body.code):
            raise Problem(
                HTTPStatus.FORBIDDEN, "This is not the code.", "Read it in the terminal where Ambula was started."
            )
        account = records.add_account(database, body.login, Role.ADMIN, gateway.settings.clinic, kept, site_admin=True)
        answer = _signed_in(database, account, request, response, gateway)
    first_run.forget_code(gateway.settings.data_dir)
    return answer


@router.post("/sign-in", dependencies=OPEN_TO_ALL, responses=documented(HTTPStatus.UNAUTHORIZED))
def sign_in(body: SignInIn, request: Request, response: Response, gateway: Parts) -> MeOut:
    """Sign in with a local account; the browser is given a cookie."""
    now = datetime.now(UTC)
    with gateway.database.transaction(EVERYTHING) as database:
        account = records.find_login(database, body.login)
        open_now = account is not None and not account.disabled and not records.is_locked(account, now)
        kept = account.password if account is not None and open_now else None
    fits = gateway.passwords.fits(kept, body.password.get_secret_value())
    with gateway.database.transaction(EVERYTHING) as database:
        account = records.find_login(database, body.login)
        if account is not None and fits:
            records.note_success(account)
            return _signed_in(database, account, request, response, gateway)
        if account is not None and open_now:
            records.note_failure(account, now, gateway.parameters)
    raise Problem(HTTPStatus.UNAUTHORIZED, WRONG, TRY_AGAIN)


@router.post("/sign-in/renewal", dependencies=KNOWN, responses=documented(HTTPStatus.CONFLICT))
def renew_sign_in(caller: Identified, request: Request, response: Response, gateway: Parts) -> MeOut:
    """A new secret for the browser's cookie; pages that stay open ask for it now and then."""
    now = datetime.now(UTC)
    with gateway.database.transaction(EVERYTHING) as database:
        row = sign_ins.find(database, cookie_of(request), now, gateway.parameters)
        if row is None:
            raise NotKnown
        _set_cookie(request, response, sign_ins.renew(row, now))
        return _me(database, caller)


@router.post("/sign-out", status_code=HTTPStatus.NO_CONTENT, dependencies=KNOWN, responses=documented())
def sign_out(caller: Identified, request: Request, response: Response, gateway: Parts) -> None:
    """End this browser's sign-in."""
    with gateway.database.transaction(EVERYTHING) as database:
        row = database.get(SignInRow, caller.sign_in) if caller.sign_in is not None else None
        if row is not None:
            database.delete(row)
    response.delete_cookie(cookie_name(request), path="/")


@router.get("/me", dependencies=KNOWN, responses=documented())
def read_me(caller: Identified, gateway: Parts) -> MeOut:
    """Who is signed in, and what they may do."""
    with gateway.database.transaction(EVERYTHING) as database:
        return _me(database, caller)


def _signed_in(database: Session, account: AccountRow, request: Request, response: Response, gateway: Gateway) -> MeOut:
    cookie = sign_ins.begin(database, account, datetime.now(UTC))
    database.flush()
    _set_cookie(request, response, cookie)
    caller = sign_ins.find_caller(database, cookie, datetime.now(UTC), gateway.parameters)
    assert caller is not None
    request.state.caller = caller
    return _me(database, caller)


def _set_cookie(request: Request, response: Response, cookie: str) -> None:
    # Without a lifetime of its own it goes with the browser; the gateway decides when it ends before that.
    response.set_cookie(
        cookie_name(request), cookie, path="/", httponly=True, samesite="strict", secure=request.url.scheme == "https"
    )


def _me(database: Session, caller: Caller) -> MeOut:
    clinic = database.get_one(ClinicRow, caller.clinic)
    return MeOut(
        account=caller.account,
        login=caller.login,
        role=caller.role,
        clinic=clinic.id,
        clinic_name=clinic.name,
        site_admin=caller.site_admin,
        may=[permission for permission in Permission if caller.may(permission)],
    )
