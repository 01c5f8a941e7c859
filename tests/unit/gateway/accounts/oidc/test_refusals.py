"""What a browser, a service or somebody between them may try. Nobody is signed in by any of it."""

import threading
import time
from functools import partial
from http import HTTPStatus
from urllib.parse import parse_qsl, urlsplit

import jwt
import pytest
from cryptography.hazmat.primitives.asymmetric import ec

from services.gateway.accounts.oidc import fetching
from services.gateway.accounts.oidc.routes import OidcServices
from services.gateway.accounts.oidc.service import MOST_AT_ONCE

CALLBACK = "/v1/sign-in/oidc/hospital/callback"


@pytest.fixture
def refused(clinic):
    """Checks that a browser was refused, with the problem, and is signed in nowhere."""

    def check(answer, problem):
        assert (answer.status_code, answer.headers["location"]) == (303, f"/#/sign-in?problem={problem}")
        assert clinic.sign_ins() == []

    return check


def unsigned(service, claims):
    return jwt.encode(claims, None, "none", {"kid": service.key_id})


def by_secret(service, claims):
    # The classic confusion: the public key, which anybody has, taken for a shared secret.
    return jwt.encode(claims, service.keys()["keys"][0]["x"] * 2, "HS256", {"kid": service.key_id})


def by_another_key(service, claims):
    return jwt.encode(claims, ec.generate_private_key(ec.SECP256R1()), "ES256", {"kid": service.key_id})


def by_an_unknown_key(service, claims):
    return jwt.encode(claims, ec.generate_private_key(ec.SECP256R1()), "ES256", {"kid": "other"})


def altered(service, claims):
    header, _, signature = jwt.encode(claims, service.key, "ES256", {"kid": service.key_id}).split(".")
    other = jwt.encode(claims | {"sub": "somebody else"}, service.key, "ES256", {"kid": service.key_id})
    return f"{header}.{other.split('.')[1]}.{signature}"


@pytest.fixture
def refused_all(clinic, visit, made, refused):
    """Visits once for each case, after `lie` has been told it."""

    def visit_all(cases, lie):
        made()
        for case in cases:
            lie(case)
            refused(visit(clinic.browser()), "refused")

    return visit_all


def test_a_token_that_the_service_did_not_sign(service, refused_all):
    forgers = (unsigned, by_secret, by_another_key, by_an_unknown_key, altered)
    refused_all(forgers, lambda forge: setattr(service, "sign", partial(forge, service)))


def test_a_token_that_says_something_else(service, refused_all):
    now = int(time.time())
    wrong = (
        {"aud": "another client"},
        {"aud": None},
        {"aud": ["ambula", "another client"]},
        {"aud": ["ambula", "another client"], "azp": "another client"},
        {"azp": "another client"},
        {"iss": "https://evil.example"},
        {"iss": None},
        {"exp": now - 120},
        {"exp": None},
        {"iat": now + 600},
        {"nonce": "another"},
        {"nonce": None},
        {"nonce": 7},
        {"sub": None},
        {"auth_time": 1e300},
    )
    refused_all(wrong, lambda claims: setattr(service, "claims", claims))


def test_an_answer_without_a_token(service, refused_all):
    answers = ({"id_token": "no token"}, {"id_token": 7}, {"id_token": "a.b.c"}, {})
    refused_all(answers, lambda answer: service.answers.update({"/token": answer}))


class TestComingBack:
    @pytest.fixture
    def back(self, service, visit, made):
        made()
        return lambda browser: service.authorize(dict(parse_qsl(urlsplit(visit.leave(browser)).query)))

    def test_twice(self, clinic, back):
        browser = clinic.browser()
        address, held = back(browser), dict(browser.cookies)
        assert browser.get(address, follow_redirects=False).headers["location"] == "/"
        browser.cookies.clear()
        browser.cookies.update(held)
        answer = browser.get(address, follow_redirects=False)
        assert answer.headers["location"] == "/#/sign-in?problem=expired"
        assert len(clinic.sign_ins()) == 1

    def test_in_another_browser(self, clinic, back, refused):
        # Somebody sends the link of their own sign-in to a colleague, who would work under the wrong name.
        refused(clinic.browser().get(back(clinic.browser()), follow_redirects=False), "expired")
        other = clinic.browser()
        back(other)
        refused(other.get(back(clinic.browser()), follow_redirects=False), "expired")

    def test_without_having_left(self, clinic, refused):
        for query in ("", "?code=a", "?state=a&code=b", "?state=&code=b"):
            refused(clinic.browser().get(CALLBACK + query, follow_redirects=False), "expired")

    def test_from_another_service(self, clinic, back, refused):
        browser = clinic.browser()
        address = back(browser).partition("&iss=")[0]
        refused(browser.get(f"{address}&iss=https://evil.example", follow_redirects=False), "refused")

    def test_with_another_code(self, clinic, back, refused):
        browser = clinic.browser()
        address = back(browser).replace("code=", "code=0")
        refused(browser.get(address, follow_redirects=False), "unavailable")

    def test_with_nothing_but_an_error(self, clinic, visit, refused):
        browser = clinic.browser()
        state = dict(parse_qsl(urlsplit(visit.leave(browser)).query))["state"]
        answer = browser.get(f"{CALLBACK}?state={state}&error=access_denied", follow_redirects=False)
        refused(answer, "refused")
        entry = clinic.audit()[-1]
        assert (entry.action, entry.reason, entry.actor) == ("come_back_from_provider", "refused", None)


class TestService:
    """It is away, slow, or not what it was."""

    @pytest.mark.parametrize("path", ["/.well-known/openid-configuration", "/token", "/keys"])
    def test_answers_nonsense(self, clinic, service, made, refused, path):
        made()
        for document in (None, [], b"no json", b"\xff", "http://127.0.0.1:9/elsewhere", {}):
            clinic.app.state.oidc = OidcServices(clinic.gateway.settings.oidc)
            service.answers[path] = document
            browser = clinic.browser()
            answer = browser.get("/v1/sign-in/oidc/hospital", follow_redirects=False)
            if answer.headers["location"].startswith(service.issuer):
                back = service.authorize(dict(parse_qsl(urlsplit(answer.headers["location"]).query)))
                answer = browser.get(back, follow_redirects=False)
            refused(answer, "refused" if (path, document) == ("/token", {}) else "unavailable")

    def test_is_away(self, clinic, service, refused):
        service.close()
        refused(clinic.browser().get("/v1/sign-in/oidc/hospital", follow_redirects=False), "unavailable")

    def test_has_parts_that_anybody_could_listen_to(self, clinic, service, visit, made, refused):
        made()
        for part in ("token_endpoint", "jwks_uri"):
            clinic.app.state.oidc = OidcServices(clinic.gateway.settings.oidc)
            listened = service.discovery() | {part: "http://hospital.example/"}
            service.answers["/.well-known/openid-configuration"] = listened
            refused(visit(clinic.browser()), "unavailable")

    def test_answers_without_end(self, clinic, service, refused, monkeypatch):
        monkeypatch.setattr(fetching, "MOST_BYTES", 1000)
        service.answers["/.well-known/openid-configuration"] = service.discovery() | {"more": "x" * 1000}
        refused(clinic.browser().get("/v1/sign-in/oidc/hospital", follow_redirects=False), "unavailable")

    def test_changes_its_keys(self, clinic, service, visit, made, monkeypatch):
        made()
        visit(clinic.browser())
        service.key, service.key_id = ec.generate_private_key(ec.SECP256R1()), "second"
        clock = time.monotonic() + 61
        monkeypatch.setattr("services.gateway.accounts.oidc.service.time.monotonic", lambda: clock)
        assert visit(clinic.browser()).headers["location"] == "/"
        assert service.asked.count("/keys") == 2

    def test_is_not_asked_for_keys_by_every_token_that_names_another(self, clinic, service, visit, made, monkeypatch):
        made()
        visit(clinic.browser())
        monkeypatch.setattr(service, "sign", lambda claims: by_an_unknown_key(service, claims))
        for _ in range(3):
            assert visit(clinic.browser()).headers["location"] == "/#/sign-in?problem=refused"
        assert service.asked.count("/keys") == 1

    def test_takes_its_time_and_nobody_else_waits(self, clinic, service):
        asked, answer, discovery = threading.Semaphore(0), threading.Event(), service.discovery

        def slow():
            asked.release()
            answer.wait(30)
            return discovery()

        service.discovery = slow
        answers = []

        def leave():
            answers.append(clinic.browser().get("/v1/sign-in/oidc/hospital", follow_redirects=False))

        waiting = [threading.Thread(target=leave) for _ in range(MOST_AT_ONCE)]
        for each in waiting:
            each.start()
        for _ in waiting:
            asked.acquire()
        one_more = clinic.browser().get("/v1/sign-in/oidc/hospital", follow_redirects=False)
        assert one_more.headers["location"] == "/#/sign-in?problem=unavailable"
        assert clinic.browser().get("/v1/sign-in").status_code == HTTPStatus.OK
        answer.set()
        for each in waiting:
            each.join()
        assert all(each.headers["location"].startswith(service.issuer) for each in answers)
