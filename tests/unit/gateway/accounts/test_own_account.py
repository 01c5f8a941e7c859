"""One's own account: another password, the password once more, and the other browsers."""

from http import HTTPStatus

import pytest

from services.gateway.access.confirmation import TITLE, Confirmed
from services.gateway.access.identify import COOKIE
from services.gateway.access.roles import Role
from services.gateway.access.rules import KNOWN

PASSWORD, NEXT, WRONG = "three quiet steps", "seven slow strides", "four loud strides"
OK, GONE = HTTPStatus.NO_CONTENT, HTTPStatus.UNAUTHORIZED


@pytest.fixture
def sign_in(clinic):
    """Browsers of one therapist with a password."""
    clinic.account("m.arnold")

    def open_browser(password=PASSWORD):
        browser = clinic.browser()
        answer = browser.post("/v1/sign-in", json={"login": "m.arnold", "password": password})
        browser.status = answer.status_code
        return browser

    return open_browser


def change(browser, password=PASSWORD, new_password=NEXT):
    return browser.put("/v1/me/password", json={"password": password, "new_password": new_password})


def confirm(browser, password=PASSWORD):
    return browser.post("/v1/sign-in/confirmation", json={"password": password})


def test_another_password_signs_every_other_browser_out(sign_in):
    browser, other = sign_in(), sign_in()
    before = browser.cookies[COOKIE]
    assert change(browser).status_code == OK
    assert browser.get("/v1/me").status_code == HTTPStatus.OK
    assert browser.cookies[COOKIE].split(".")[0] != before.split(".")[0]
    assert other.get("/v1/me").status_code == GONE
    assert sign_in().status == GONE
    assert sign_in(NEXT).status == HTTPStatus.OK


def test_without_the_old_one_there_is_no_new_one_and_guessing_closes_the_account(sign_in, clinic):
    browser = sign_in()
    for _ in range(clinic.gateway.parameters.free_failures + 1):
        answer = change(browser, WRONG)
        assert (answer.status_code, answer.json()["title"]) == (HTTPStatus.FORBIDDEN, "Wrong password")
    assert change(browser).status_code == HTTPStatus.FORBIDDEN
    assert browser.get("/v1/me").status_code == HTTPStatus.OK


def test_a_weak_one_is_not_taken(sign_in):
    for weak in ("short", "aaaaaaaaaaaaaa", "I am m.arnold!!"):
        assert change(sign_in(), new_password=weak).status_code == HTTPStatus.UNPROCESSABLE_ENTITY, weak
    assert sign_in().status == HTTPStatus.OK


def test_the_other_browsers_are_signed_out_on_request(sign_in):
    browsers = [sign_in() for _ in range(3)]
    assert browsers[1].delete("/v1/me/sign-ins").json() == {"ended": 2}
    assert [browser.get("/v1/me").status_code for browser in browsers] == [GONE, HTTPStatus.OK, GONE]


def test_what_can_not_be_undone_needs_the_password_of_the_last_minutes(sign_in, clinic):
    @clinic.app.post("/v1/for-good", dependencies=KNOWN)
    def for_good(_: Confirmed) -> str:
        return "done"

    browser, other = sign_in(), sign_in()
    assert browser.post("/v1/for-good").json() == "done"
    clinic.age_sign_ins(confirmed=301)
    refused = browser.post("/v1/for-good")
    assert (refused.status_code, refused.json()["title"]) == (HTTPStatus.FORBIDDEN, TITLE)
    wrong = confirm(browser, WRONG)
    assert (wrong.status_code, wrong.json()["title"]) == (HTTPStatus.FORBIDDEN, "Wrong password")
    assert browser.post("/v1/for-good").status_code == HTTPStatus.FORBIDDEN
    assert confirm(browser).status_code == OK
    assert browser.post("/v1/for-good").json() == "done"
    assert other.post("/v1/for-good").status_code == HTTPStatus.FORBIDDEN, "this browser alone"
    assert browser.post("/v1/sign-in/renewal").status_code == HTTPStatus.OK
    clinic.age_sign_ins(confirmed=301)
    assert browser.post("/v1/for-good").status_code == HTTPStatus.FORBIDDEN, "a renewal is no password"


def test_a_key_has_no_password_and_no_browsers(clinic):
    @clinic.app.post("/v1/for-good", dependencies=KNOWN)
    def for_good(_: Confirmed) -> str:
        return "done"

    made = clinic.browser(Role.ADMIN).post("/v1/keys", json={"name": "export", "role": "service", "days": 1}).json()
    machine = clinic.browser()
    machine.headers["authorization"] = f"Bearer {made['key']}"
    assert machine.get("/v1/me").json()["login"] == "export"
    for answer in (
        confirm(machine),
        change(machine),
        machine.delete("/v1/me/sign-ins"),
        machine.post("/v1/sign-in/renewal"),
        machine.post("/v1/for-good"),
    ):
        assert answer.status_code == HTTPStatus.FORBIDDEN
