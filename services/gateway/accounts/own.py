"""REST of one's own account: its password, and the browsers that are signed in to it."""

from datetime import UTC, datetime
from http import HTTPStatus

from fastapi import APIRouter, Request, Response
from sqlalchemy.orm import Session

from services.gateway.access import sign_ins
from services.gateway.access.caller import Caller
from services.gateway.access.identify import NotKnown, Person
from services.gateway.access.rules import KNOWN
from services.gateway.access.scope import EVERYTHING
from services.gateway.access.tables import AccountRow, SignInRow
from services.gateway.accounts import records
from services.gateway.accounts.attempts import Attempt
from services.gateway.accounts.browser import begin_sign_in
from services.gateway.accounts.models import ConfirmationIn, EndedOut, PasswordChange
from services.gateway.accounts.routes import refuse_weak
from services.gateway.context import Gateway, Parts
from services.gateway.problems import Problem, documented

router = APIRouter(prefix="/v1", tags=["accounts"])


class WrongPassword(Problem):
    """Not a 401: the browser is signed in, and stays so."""

    title = "Wrong password"

    def __init__(self) -> None:
        super().__init__(
            HTTPStatus.FORBIDDEN,
            "This is not your password, or your account is closed for a while.",
            "Try again; after several wrong passwords an account closes for a minute, then longer.",
        )


REFUSALS = documented(HTTPStatus.FORBIDDEN, HTTPStatus.CONFLICT, HTTPStatus.SERVICE_UNAVAILABLE)


@router.post("/sign-in/confirmation", status_code=HTTPStatus.NO_CONTENT, dependencies=KNOWN, responses=REFUSALS)
def confirm_password(body: ConfirmationIn, caller: Person, gateway: Parts) -> None:
    """Give the password once more; what can not be undone is open to this browser for five minutes."""
    attempt = _tried(gateway, caller, body.password.get_secret_value())
    with gateway.database.transaction(EVERYTHING) as database:
        _succeed(database, attempt)
        _own_sign_in(database, caller).confirmed = datetime.now(UTC)


@router.put("/me/password", status_code=HTTPStatus.NO_CONTENT, dependencies=KNOWN, responses=REFUSALS)
def change_own_password(
    body: PasswordChange, caller: Person, request: Request, response: Response, gateway: Parts
) -> None:
    """Choose another password. Every browser is signed out but this one, which is given a new cookie."""
    new = body.new_password.get_secret_value()
    attempt = _tried(gateway, caller, body.password.get_secret_value())
    refuse_weak(new, caller.login)
    kept = gateway.passwords.keep(new)
    with gateway.database.transaction(EVERYTHING) as database:
        account = _succeed(database, attempt)
        account.password = kept
        sign_ins.end_all(database, account.id)
        begin_sign_in(database, account, request, response)


@router.delete("/me/sign-ins", dependencies=KNOWN, responses=documented(HTTPStatus.FORBIDDEN))
def end_other_sign_ins(caller: Person, gateway: Parts) -> EndedOut:
    """Sign out every browser of this account but the one that asks."""
    with gateway.database.transaction(EVERYTHING) as database:
        return EndedOut(ended=sign_ins.end_all(database, caller.account, but=caller.sign_in))


def _tried(gateway: Gateway, caller: Caller, password: str) -> Attempt:
    with gateway.database.transaction(EVERYTHING) as database:
        if records.get_account(database, caller.account).password is None:
            raise Problem(
                HTTPStatus.CONFLICT,
                "Your password is not known here: you sign in with your organisation's service.",
                "To confirm, sign in there again with GET /v1/sign-in/oidc/{provider}?again=true.",
            )
    attempt = Attempt(caller.login, password)
    if not attempt.fits(gateway):
        raise WrongPassword
    return attempt


def _succeed(database: Session, attempt: Attempt) -> AccountRow:
    account = attempt.succeed(database)
    if account is None:
        raise WrongPassword
    return account


def _own_sign_in(database: Session, caller: Caller) -> SignInRow:
    row = database.get(SignInRow, caller.sign_in)
    if row is None:
        raise NotKnown
    return row
