"""REST of signing in with the organisation's own service. Browsers go there and come back; both answers lead on."""

import logging
from datetime import UTC, datetime
from http import HTTPStatus
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Depends, Path, Query, Request
from fastapi.responses import RedirectResponse
from starlette.requests import HTTPConnection

from services.bus.logs import event
from services.gateway.access.identify import is_secure
from services.gateway.access.rules import OPEN_TO_ALL
from services.gateway.access.scope import EVERYTHING
from services.gateway.accounts.browser import begin_sign_in
from services.gateway.accounts.oidc.fetching import Unreachable
from services.gateway.accounts.oidc.flows import LONGEST_S, Flows
from services.gateway.accounts.oidc.linking import account_of
from services.gateway.accounts.oidc.service import OidcService
from services.gateway.accounts.oidc.settings import OidcProvider
from services.gateway.accounts.oidc.tokens import Claims, NotBelieved
from services.gateway.audit import records as audit
from services.gateway.audit.noting import Noted, note
from services.gateway.audit.trail import entry_of
from services.gateway.context import Gateway, Parts
from services.gateway.problems import Problem, documented

log = logging.getLogger(__name__)
router = APIRouter(prefix="/v1/sign-in/oidc", tags=["accounts"])

COOKIE = "ambula-oidc"
NEVER = datetime(1970, 1, 1, tzinfo=UTC)

Refusal = Literal["expired", "refused", "no_account", "unavailable"]
"""What the page of the sign-in is told, as `problem` in its address."""

ProviderInPath = Annotated[
    str, Path(pattern=r"^[a-z0-9][a-z0-9-]{0,31}$", description="name of a sign-in service", examples=["clinic"])
]
LEADS_ON: dict[int | str, dict[str, Any]] = {
    HTTPStatus.SEE_OTHER.value: {
        "description": "See Other: to the service, to the pages, or to `/#/sign-in?problem=` with one of `expired`, "
        "`refused`, `no_account`, `unavailable`"
    }
}
RESPONSES = documented(HTTPStatus.NOT_FOUND) | LEADS_ON


class OidcServices:
    """The services that the site has set up, and the browsers on their way."""

    def __init__(self, providers: dict[str, OidcProvider]) -> None:
        self._services = {name: OidcService(provider) for name, provider in providers.items()}
        self.flows = Flows()

    def service(self, name: str) -> OidcService:
        """Raises a 404 problem when there is none of that name."""
        if name not in self._services:
            raise Problem(
                HTTPStatus.NOT_FOUND,
                "There is no such sign-in service.",
                "GET /v1/sign-in names those that are set up.",
            )
        return self._services[name]


def _of(connection: HTTPConnection) -> OidcServices:
    services = connection.app.state.oidc
    assert isinstance(services, OidcServices)
    return services


Services = Annotated[OidcServices, Depends(_of)]


@router.get("/{provider}", dependencies=OPEN_TO_ALL, responses=RESPONSES, status_code=HTTPStatus.SEE_OTHER)
def leave_for_provider(
    provider: ProviderInPath,
    request: Request,
    gateway: Parts,
    services: Services,
    again: Annotated[bool, Query(description="have the password asked for once more, to confirm something")] = False,
) -> RedirectResponse:
    """Send the browser to a sign-in service."""
    service, flow = services.service(provider), services.flows.begin(provider, again=again)
    try:
        address = service.address(flow.state, flow.nonce, flow.verifier, _way_back(gateway, provider), again=flow.again)
    except Unreachable as error:
        return _refused(request, provider, "unavailable", str(error))
    answer = RedirectResponse(address, HTTPStatus.SEE_OTHER)
    # Lax, as it has to come along when the service sends the browser back.
    answer.set_cookie(
        _cookie_name(request), flow.browser, max_age=int(LONGEST_S), path="/", httponly=True, samesite="lax",
        secure=is_secure(request),
    )  # fmt: skip
    return answer


@router.get("/{provider}/callback", dependencies=OPEN_TO_ALL, responses=RESPONSES, status_code=HTTPStatus.SEE_OTHER)
def come_back_from_provider(
    provider: ProviderInPath,
    request: Request,
    gateway: Parts,
    services: Services,
    state: Annotated[str, Query(max_length=200, description="as it was sent along")] = "",
    code: Annotated[str | None, Query(max_length=4096, description="to be exchanged for who it is")] = None,
    iss: Annotated[str | None, Query(max_length=200, description="which service sends the browser back")] = None,
) -> RedirectResponse:
    """Take back a browser from a sign-in service, and sign it in. Works once."""
    service = services.service(provider)
    flow = services.flows.take(provider, state, request.cookies.get(_cookie_name(request), ""))
    if flow is None:
        return _refused(request, provider, "expired", "no browser left with this state")
    if code is None or (iss is not None and iss != service.provider.issuer):
        return _refused(request, provider, "refused", "the service sent no code, or another one did")
    try:
        claims = service.claims(code, flow.nonce, flow.verifier, _way_back(gateway, provider))
    except Unreachable as error:
        return _refused(request, provider, "unavailable", str(error))
    except NotBelieved as error:
        return _refused(request, provider, "refused", str(error))
    return _sign_in(request, gateway, provider, service.provider, claims)


def _sign_in(request: Request, gateway: Gateway, name: str, provider: OidcProvider, claims: Claims) -> RedirectResponse:
    answer = RedirectResponse("/", HTTPStatus.SEE_OTHER)
    with gateway.database.transaction(EVERYTHING) as database:
        account = account_of(database, provider, claims)
        if account is not None:
            # Somebody who was signed in there already has not given a password now.
            begin_sign_in(database, account, request, answer, confirmed=claims.authenticated or NEVER)
            entry = entry_of(request.scope, "sign_in_with_provider", HTTPStatus.SEE_OTHER, datetime.now(UTC))
            audit.append(database, entry)
    if account is None:
        return _refused(request, name, "no_account", "nobody here is linked to them")
    answer.delete_cookie(_cookie_name(request), path="/", secure=is_secure(request), httponly=True, samesite="lax")
    return answer


def _refused(request: Request, provider: str, problem: Refusal, why: str) -> RedirectResponse:
    log.info(event("oidc_refused", provider=provider, problem=problem, why=why))
    note(request, Noted(reason=problem))
    return RedirectResponse(f"/#/sign-in?problem={problem}", HTTPStatus.SEE_OTHER)


def _way_back(gateway: Gateway, provider: str) -> str:
    """Never from the request: whoever could choose it would be sent other people's codes."""
    return f"{gateway.settings.public_url or gateway.settings.url}/v1/sign-in/oidc/{provider}/callback"


def _cookie_name(request: Request) -> str:
    return f"__Host-{COOKIE}" if is_secure(request) else COOKIE
