"""REST of signing in and out."""

from datetime import UTC, datetime
from http import HTTPStatus

from fastapi import APIRouter, Request, Response

from services.gateway.access import sign_ins
from services.gateway.access.identify import Identified, NotKnown, Person, cookie_of
from services.gateway.access.roles import Role
from services.gateway.access.rules import KNOWN, OPEN_TO_ALL
from services.gateway.access.scope import EVERYTHING
from services.gateway.accounts import first_run, records
from services.gateway.accounts.attempts import Attempt
from services.gateway.accounts.browser import begin_sign_in, give_cookie, me, take_cookie
from services.gateway.accounts.models import FirstRunIn, MeOut, SignInIn, SignInState
from services.gateway.accounts.passwords import weakness
from services.gateway.audit.noting import Noted, note
from services.gateway.context import Gateway, Parts
from services.gateway.problems import Problem, documented

router = APIRouter(prefix="/v1", tags=["accounts"])

WRONG = "The name or the password is wrong, or the account is closed for a while."
TRY_AGAIN = "Try again; after several wrong passwords an account closes for a minute, then longer."


@router.get("/sign-in", dependencies=OPEN_TO_ALL, responses=documented())
def read_sign_in_state(gateway: Parts) -> SignInState:
    """How one can sign in here."""
    with gateway.database.transaction(EVERYTHING) as database:
        return SignInState(first_run=not records.has_accounts(database), providers=sorted(gateway.settings.oidc))


@router.post(
    "/first-run",
    status_code=HTTPStatus.CREATED,
    dependencies=OPEN_TO_ALL,
    responses=documented(HTTPStatus.CONFLICT, HTTPStatus.FORBIDDEN, HTTPStatus.SERVICE_UNAVAILABLE),
)
def create_first_administrator(body: FirstRunIn, request: Request, response: Response, gateway: Parts) -> MeOut:
    """Create the first account, an administrator of the whole site, and sign in. Works once."""
    with gateway.database.transaction(EVERYTHING) as database:
        has_accounts = records.has_accounts(database)
    _check_first(gateway, body, has_accounts)
    refuse_weak(body.password.get_secret_value(), body.login)
    kept = gateway.passwords.keep(body.password.get_secret_value())
    with gateway.database.transaction(EVERYTHING) as database:
        records.one_at_a_time(database)
        _check_first(gateway, body, records.has_accounts(database))
        account = records.add_account(database, body.login, Role.ADMIN, gateway.settings.clinic, kept, site_admin=True)
        caller = begin_sign_in(database, account, request, response)
        answer = me(database, caller, gateway.settings)
    first_run.forget_code(gateway.settings.own_dir)
    return answer


def _check_first(gateway: Gateway, body: FirstRunIn, has_accounts: bool) -> None:
    if has_accounts:
        raise Problem(HTTPStatus.CONFLICT, "There are accounts already.", "Sign in, or ask an administrator.")
    if not first_run.is_code(gateway.settings.own_dir, body.code):
        raise Problem(
            HTTPStatus.FORBIDDEN, "This is not the code.", "Read it in the terminal where Ambula was started."
        )


def refuse_weak(password: str, login: str) -> None:
    """Raises a 422 problem for a new password that is easily guessed."""
    reason = weakness(password, login)
    if reason is not None:
        raise Problem(
            HTTPStatus.UNPROCESSABLE_ENTITY,
            f"The new password is easily guessed: {reason}.",
            "Choose another one; several words that do not belong together are good.",
        )


@router.post(
    "/sign-in",
    dependencies=OPEN_TO_ALL,
    responses=documented(HTTPStatus.UNAUTHORIZED, HTTPStatus.SERVICE_UNAVAILABLE),
)
def sign_in(body: SignInIn, request: Request, response: Response, gateway: Parts) -> MeOut:
    """Sign in with a local account; the browser is given a cookie."""
    attempt = Attempt(body.login, body.password.get_secret_value())
    if attempt.fits(gateway):
        with gateway.database.transaction(EVERYTHING) as database:
            account = attempt.succeed(database)
            if account is not None:
                caller = begin_sign_in(database, account, request, response)
                return me(database, caller, gateway.settings)
    # Only the id of an account that exists: what was typed may be a password in the wrong place.
    note(request, Noted(object=None if attempt.account is None else f"account={attempt.account}"))
    raise Problem(HTTPStatus.UNAUTHORIZED, WRONG, TRY_AGAIN)


@router.post("/sign-in/renewal", dependencies=KNOWN, responses=documented(HTTPStatus.FORBIDDEN))
def renew_sign_in(caller: Person, request: Request, response: Response, gateway: Parts) -> MeOut:
    """A new secret for the browser's cookie; pages that stay open ask for it now and then.

    Asked for more often than once a minute, the secret stays.
    """
    now = datetime.now(UTC)
    with gateway.database.transaction(EVERYTHING) as database:
        row = sign_ins.find(database, cookie_of(request), now, gateway.parameters)
        if row is not None:
            cookie = sign_ins.renew(row, now, gateway.parameters)
            if cookie is not None:
                give_cookie(request, response, cookie)
            return me(database, caller, gateway.settings)
    # Outside of the transaction, so that the end of a copied sign-in stays.
    raise NotKnown


@router.post("/sign-out", status_code=HTTPStatus.NO_CONTENT, dependencies=KNOWN, responses=documented())
def sign_out(caller: Identified, request: Request, response: Response, gateway: Parts) -> None:
    """End this browser's sign-in."""
    with gateway.database.transaction(EVERYTHING) as database:
        if caller.sign_in is not None:
            sign_ins.end(database, caller.sign_in)
    take_cookie(request, response)


@router.get("/me", dependencies=KNOWN, responses=documented())
def read_me(caller: Identified, gateway: Parts) -> MeOut:
    """Who is signed in, and what they may do."""
    with gateway.database.transaction(EVERYTHING) as database:
        return me(database, caller, gateway.settings)
