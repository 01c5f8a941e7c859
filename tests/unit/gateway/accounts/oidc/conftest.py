"""A gateway that sends browsers to a sign-in service on loopback."""

from urllib.parse import parse_qsl, urlsplit

import pytest
from pydantic import SecretStr

from services.gateway.accounts.oidc.settings import OidcProvider
from services.gateway.settings import GatewaySettings
from tests.unit.gateway.accounts.oidc.provider import CLIENT, SECRET, SignInService


@pytest.fixture
def service():
    running = SignInService()
    yield running
    running.close()


@pytest.fixture
def provider(service):
    return OidcProvider(issuer=service.issuer, client_id=CLIENT, client_secret=SecretStr(SECRET))


@pytest.fixture
def settings(settings, provider) -> GatewaySettings:
    return settings.model_copy(update={"oidc": {"hospital": provider}, "public_url": "http://testserver"})


@pytest.fixture
def visit(service):
    """Send a browser there and back; the answer to its coming back."""

    def leave(browser, again=False):
        answer = browser.get(f"/v1/sign-in/oidc/hospital?again={str(again).lower()}", follow_redirects=False)
        assert answer.status_code == 303, answer.text
        return answer.headers["location"]

    def there_and_back(browser, again=False):
        back = service.authorize(dict(parse_qsl(urlsplit(leave(browser, again)).query)))
        return browser.get(back, follow_redirects=False)

    there_and_back.leave = leave
    return there_and_back


@pytest.fixture
def made(clinic, service):
    """Make the account of somebody who signs in there."""

    def make(login="m.arnold@clinic.example", **values):
        account = clinic.account(login, password=None)
        clinic.change(account, **{"issuer": service.issuer} | values)
        return account

    return make
