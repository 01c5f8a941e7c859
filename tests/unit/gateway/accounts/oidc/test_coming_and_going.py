"""Signing in with a service: the way there and back, whose account it is, and what confirming means then."""

from datetime import UTC, datetime, timedelta
from http import HTTPStatus
from urllib.parse import parse_qsl, urlsplit

import pytest
from pydantic import SecretStr, ValidationError

from services.gateway.access.roles import Role
from services.gateway.accounts.oidc.flows import LONGEST_S, MOST, Flows
from services.gateway.accounts.oidc.settings import OidcProvider

SIGNED_IN = "/"


def refused(problem):
    return f"/#/sign-in?problem={problem}"


def test_the_browser_is_sent_with_everything_that_binds_its_return(clinic, service, visit):
    browser = clinic.browser()
    address = urlsplit(visit.leave(browser))
    asked = dict(parse_qsl(address.query))
    assert address._replace(query="").geturl() == f"{service.issuer}/authorize"
    assert asked["redirect_uri"] == "http://testserver/v1/sign-in/oidc/hospital/callback"
    assert (asked["response_type"], asked["scope"]) == ("code", "openid email profile")
    assert asked["code_challenge_method"] == "S256"
    assert len({asked["state"], asked["nonce"], asked["code_challenge"]}) == 3
    assert all(len(asked[name]) >= 43 for name in ("state", "nonce", "code_challenge"))
    assert "prompt" not in asked
    assert browser.cookies["ambula-oidc"] not in asked.values()


def test_the_way_back_is_the_sites_own_whatever_the_host_header_says(clinic):
    answer = clinic.browser().get(
        "/v1/sign-in/oidc/hospital", headers={"x-forwarded-host": "evil.example"}, follow_redirects=False
    )
    assert "evil" not in answer.headers["location"]


def test_an_account_made_for_them_is_linked_and_stays_theirs_under_another_address(clinic, service, visit, made):
    account, browser = made(), clinic.browser()
    answer = visit(browser)
    assert (answer.status_code, answer.headers["location"]) == (HTTPStatus.SEE_OTHER, SIGNED_IN)
    assert browser.get("/v1/me").json() | {"account": account, "provider": "hospital"} == browser.get("/v1/me").json()
    assert "ambula-oidc" not in browser.cookies
    service.person["email"] = "m.brunner@clinic.example"
    again = clinic.browser()
    assert visit(again).headers["location"] == SIGNED_IN
    assert again.get("/v1/me").json()["account"] == account
    signed_in = [entry for entry in clinic.audit() if entry.action == "sign_in_with_provider"]
    assert [(entry.actor, entry.object) for entry in signed_in] == [(account, "provider=hospital")] * 2


def test_somebody_else_with_the_same_address_is_not_let_in(clinic, service, visit, made):
    made()
    visit(clinic.browser())
    service.person["sub"] = "another"
    assert visit(clinic.browser()).headers["location"] == refused("no_account")


NOT_VOUCHED_FOR = (
    {"email": "x@clinic.example"},
    {"email_verified": False},
    {"email_verified": "true"},
    {"email": None},
    {"email": 7},
    {"sub": "s" * 201},
)


def test_who_is_not_vouched_for_has_no_account(clinic, service, visit, made):
    made()
    for claims in NOT_VOUCHED_FOR:
        service.claims, browser = claims, clinic.browser()
        assert visit(browser).headers["location"] == refused("no_account"), claims
        assert browser.get("/v1/me").status_code == HTTPStatus.UNAUTHORIZED, claims


def test_an_account_with_a_password_is_never_taken_over(clinic, visit):
    clinic.account("m.arnold@clinic.example", role=Role.ADMIN)
    assert visit(clinic.browser()).headers["location"] == refused("no_account")


def test_an_account_made_for_another_service_is_not_taken_over(clinic, visit, made):
    made(issuer="https://other.example")
    assert visit(clinic.browser()).headers["location"] == refused("no_account")


def test_a_closed_account_stays_closed(clinic, visit, made):
    made(disabled=True)
    assert visit(clinic.browser()).headers["location"] == refused("no_account")
    assert clinic.sign_ins() == []


def test_nobody_is_given_an_account_unless_the_site_says_which(clinic, visit):
    assert visit(clinic.browser()).headers["location"] == refused("no_account")
    assert clinic.find("m.arnold@clinic.example") is None


class TestMaking:
    @pytest.fixture
    def provider(self, provider):
        return provider.model_copy(update={"role": Role.VIEWER, "clinic": "main"})

    def test_the_site_may_say_which(self, clinic, visit):
        browser = clinic.browser()
        assert visit(browser).headers["location"] == SIGNED_IN
        me = browser.get("/v1/me").json()
        assert (me["login"], me["role"], me["clinic"]) == ("m.arnold@clinic.example", "viewer", "main")
        assert browser.post("/v1/sign-out").status_code == HTTPStatus.NO_CONTENT
        visit(browser)
        assert browser.get("/v1/me").json()["account"] == me["account"]

    def test_a_name_that_no_account_can_have_makes_none(self, clinic, service, visit):
        for email in ("ü@clinic.example", "a b", "x" * 65, ""):
            service.person["email"] = email
            assert visit(clinic.browser()).headers["location"] == refused("no_account"), email


class TestConfirming:
    def confirmed_s_ago(self, clinic):
        newest = max(clinic.sign_ins(), key=lambda row: row.created)
        return (datetime.now(UTC) - newest.confirmed).total_seconds()

    def test_a_password_given_there_just_now_counts(self, clinic, visit, made):
        made()
        address = visit.leave(clinic.browser(), again=True)
        assert {"prompt": "login", "max_age": "0"}.items() <= dict(parse_qsl(urlsplit(address).query)).items()
        visit(clinic.browser(), again=True)
        assert self.confirmed_s_ago(clinic) < 60

    def test_one_given_long_ago_does_not(self, clinic, service, visit, made):
        made()
        for auth_time in (None, 1_700_000_000, True, "now"):
            service.claims = {"auth_time": auth_time}
            visit(clinic.browser(), again=True)
            assert self.confirmed_s_ago(clinic) > timedelta(days=100).total_seconds(), auth_time

    def test_nor_does_the_future(self, clinic, service, visit, made):
        made()
        service.claims = {"auth_time": 4_000_000_000}
        visit(clinic.browser())
        assert self.confirmed_s_ago(clinic) >= 0

    def test_here_there_is_no_password_to_give(self, clinic, visit, made):
        made()
        browser = clinic.browser()
        visit(browser)
        answer = browser.post("/v1/sign-in/confirmation", json={"password": "three quiet steps"})
        assert answer.status_code == HTTPStatus.CONFLICT
        assert "again=true" in answer.json()["next_step"]


def test_a_service_that_is_not_set_up_does_not_exist(clinic):
    for path in ("/v1/sign-in/oidc/elsewhere", "/v1/sign-in/oidc/elsewhere/callback?state=a&code=b"):
        answer = clinic.browser().get(path, follow_redirects=False)
        assert answer.status_code == HTTPStatus.NOT_FOUND
    assert clinic.browser().get("/v1/sign-in").json()["providers"] == ["hospital"]


def test_flows_end_and_are_bounded(monkeypatch):
    flows = Flows()
    first = flows.begin("hospital", again=False)
    assert flows.take("hospital", first.state, first.browser) == first
    late = flows.begin("hospital", again=False)
    monkeypatch.setattr("services.gateway.accounts.oidc.flows.time.monotonic", lambda: late.began + LONGEST_S + 1)
    assert flows.take("hospital", late.state, late.browser) is None
    forgotten = flows.begin("hospital", again=False)
    for _ in range(MOST):
        flows.begin("hospital", again=False)
    assert flows.take("hospital", forgotten.state, forgotten.browser) is None
    assert len(flows._flows) == MOST


@pytest.mark.parametrize(
    "wrong",
    [{"issuer": "http://hospital.example"}, {"issuer": "ftp://127.0.0.1"}, {"role": "viewer"}, {"clinic": "main"},
     {"role": "admin", "clinic": "main"}, {"unknown": 1}, {"client_id": ""}],
)  # fmt: skip
def test_settings_that_would_be_unsafe_do_not_start(wrong):
    right = {"issuer": "https://hospital.example", "client_id": "ambula", "client_secret": SecretStr("s")}
    OidcProvider(**right)
    with pytest.raises(ValidationError):
        OidcProvider(**right | wrong)
