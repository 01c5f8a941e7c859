"""Signing in with a password: who gets in, what guessing costs, and what is left of it."""

import json
import threading
from datetime import UTC, datetime
from http import HTTPStatus

import pytest
from argon2 import PasswordHasher
from fastapi.testclient import TestClient

from services.gateway.access.roles import Role
from services.gateway.accounts import first_run
from services.gateway.accounts.passwords import MOST_AT_ONCE, MOST_WAITING, Passwords, TooManyPasswords, weakness

PASSWORD = "three quiet steps"
WRONG = "four loud strides"


def sign_in(browser, login, password=PASSWORD):
    return browser.post("/v1/sign-in", json={"login": login, "password": password})


def test_a_right_password_opens_and_signing_out_closes(clinic):
    account = clinic.account("m.arnold")
    browser = clinic.browser()
    answer = sign_in(browser, "M.Arnold")
    assert answer.status_code == HTTPStatus.OK
    assert (answer.json()["account"], answer.json()["provider"]) == (account, None)
    assert browser.get("/v1/patients").status_code == HTTPStatus.OK
    held = dict(browser.cookies)
    assert browser.post("/v1/sign-out").status_code == HTTPStatus.NO_CONTENT
    assert not browser.cookies
    browser.cookies.update(held)
    assert browser.get("/v1/patients").status_code == HTTPStatus.UNAUTHORIZED


def test_every_refusal_reads_the_same(clinic):
    disabled = clinic.account("closed")
    clinic.change(disabled, disabled=True)
    clinic.account("elsewhere", password=None)
    clinic.account("m.arnold")
    answers = [
        sign_in(clinic.browser(), login, WRONG) for login in ("m.arnold", "closed", "elsewhere", "nobody", "", "ü" * 60)
    ]
    assert {answer.status_code for answer in answers} == {HTTPStatus.UNAUTHORIZED}
    assert len({answer.text for answer in answers}) == 1
    assert not any("set-cookie" in answer.headers for answer in answers)


def test_whether_a_name_exists_is_not_told_by_the_work_that_is_done(clinic):
    clinic.change(clinic.account("closed"), disabled=True)
    clinic.account("elsewhere", password=None)
    locked = clinic.account("m.arnold")
    for _ in range(clinic.gateway.parameters.free_failures + 1):
        sign_in(clinic.browser(), "m.arnold", WRONG)
    assert clinic.find("m.arnold").locked_until is not None
    clinic.account("known")
    for login in ("known", "closed", "elsewhere", "nobody", "m.arnold"):
        clinic.hasher.costs.clear()
        sign_in(clinic.browser(), login, WRONG)
        # The same function with the same cost, once.
        assert clinic.hasher.costs == ["$argon2id$v=19$m=8,t=1,p=1"], login
    assert locked


def test_the_cost_of_nobodys_password_is_that_of_somebodys():
    passwords = Passwords()
    assert passwords._nobodys.startswith("$argon2id$v=19$m=65536,t=3,p=4$")
    assert [len(part) for part in passwords._nobodys.split("$")] == [
        len(part) for part in passwords.keep("a").split("$")
    ]


def test_guessing_closes_an_account_for_longer_each_time(clinic):
    account, free = clinic.account("m.arnold"), clinic.gateway.parameters.free_failures
    for _ in range(free):
        assert sign_in(clinic.browser(), "m.arnold", WRONG).status_code == HTTPStatus.UNAUTHORIZED
        assert clinic.find("m.arnold").locked_until is None
    waits = []
    for _ in range(9):
        sign_in(clinic.browser(), "m.arnold", WRONG)
        waits.append((clinic.find("m.arnold").locked_until - datetime.now(UTC)).total_seconds())
        assert sign_in(clinic.browser(), "m.arnold").status_code == HTTPStatus.UNAUTHORIZED, "closed for its owner, too"
        clinic.unlock(account)
    assert [round(wait / 10) * 10 for wait in waits] == [30, 60, 120, 240, 480, 960, 1920, 3600, 3600]
    assert sign_in(clinic.browser(), "m.arnold").status_code == HTTPStatus.OK
    assert (clinic.find("m.arnold").failures, clinic.find("m.arnold").locked_until) == (0, None)


def test_a_thousand_failures_are_still_an_hour(clinic):
    account = clinic.account("m.arnold")
    clinic.change(account, failures=5000)
    assert sign_in(clinic.browser(), "m.arnold", WRONG).status_code == HTTPStatus.UNAUTHORIZED
    assert (clinic.find("m.arnold").locked_until - datetime.now(UTC)).total_seconds() <= 3600


def test_guesses_at_once_are_not_more_guesses(clinic):
    clinic.account("m.arnold")
    free, seen = clinic.gateway.parameters.free_failures, []
    verify = clinic.hasher.verify

    def record(kept, password):
        seen.append(kept)
        return verify(kept, password)

    clinic.hasher.verify = record
    guesses = [
        threading.Thread(target=sign_in, args=(clinic.browser(), "m.arnold", WRONG)) for _ in range(MOST_WAITING)
    ]
    for guess in guesses:
        guess.start()
    for guess in guesses:
        guess.join()
    real = clinic.find("m.arnold").password
    assert seen.count(real) == free + 1 < len(guesses)


def test_few_wait_for_their_turn_so_that_others_are_answered():
    started, go_on = threading.Semaphore(0), threading.Event()
    passwords = Passwords(PasswordHasher(time_cost=1, memory_cost=8, parallelism=1))

    def wait():
        started.release()
        go_on.wait()

    waiting = [threading.Thread(target=passwords.fits, args=(wait, "x")) for _ in range(MOST_AT_ONCE + MOST_WAITING)]
    for each in waiting:
        each.start()
    for _ in range(MOST_AT_ONCE):
        started.acquire()
    while passwords._line.acquire(blocking=False):
        passwords._line.release()
    with pytest.raises(TooManyPasswords):
        passwords.keep("three quiet steps")
    go_on.set()
    for each in waiting:
        each.join()
    assert passwords.keep("three quiet steps")


def test_what_was_typed_is_nowhere_in_the_audit(clinic):
    account = clinic.account("m.arnold")
    sign_in(clinic.browser(), "m.arnold", "Secret.Secret.1")
    sign_in(clinic.browser(), "Secret.Secret.2", WRONG)
    sign_in(clinic.browser(), "Secret.Secret.3" * 10, WRONG)
    clinic.browser().post("/v1/sign-in", content=b'{"login": "Secret.Secret.4", "password": 7}')
    clinic.browser().post("/v1/first-run", json={"code": "Secret.Secret", "login": "Secret", "password": WRONG})
    clinic.browser().get("/v1/sign-in/oidc/secret.secret")
    clinic.browser().post("/v1/sign-in/confirmation", json={"password": "Secret.Secret.5"})
    entries = clinic.audit()
    assert [entry.outcome for entry in entries if entry.action == "sign_in"][:3] == [401, 401, 422]
    assert "Secret" not in json.dumps([str(vars(entry)) for entry in entries])
    assert entries[0].object == f"account={account}"
    assert entries[1].object is None


def test_an_account_that_is_closed_meanwhile_is_not_signed_in_to(clinic):
    account = clinic.account("m.arnold")
    verify = clinic.hasher.verify

    def close_meanwhile(kept, password):
        clinic.change(account, disabled=True)
        return verify(kept, password)

    clinic.hasher.verify = close_meanwhile
    assert sign_in(clinic.browser(), "m.arnold").status_code == HTTPStatus.UNAUTHORIZED
    assert clinic.sign_ins() == []


def test_names_and_passwords_that_no_database_takes_are_refused(clinic):
    odd = ("\x00", "\ud800", "a\x1fb")
    for login, password in (*((text, PASSWORD) for text in odd), *(("m.arnold", text) for text in odd)):
        body = json.dumps({"login": login, "password": password})
        answer = clinic.browser().post("/v1/sign-in", content=body, headers={"content-type": "application/json"})
        assert answer.status_code in (HTTPStatus.UNPROCESSABLE_ENTITY, HTTPStatus.UNAUTHORIZED)


@pytest.mark.parametrize(
    ("password", "weak"),
    [
        ("three quiet steps", False),
        ("my name is M.Arnold.", True),
        ("aaaaaaaaaaaaaaaaaaa", True),
        ("121212121212", True),
        ("correct horse 17", False),
    ],
)
def test_what_is_easily_guessed_is_not_taken(password, weak):
    assert (weakness(password, "m.arnold") is not None) is weak


class TestFirstRun:
    def body(self, clinic, login="chief", password=PASSWORD):
        return {"code": first_run.write_code(clinic.gateway.settings.own_dir), "login": login, "password": password}

    def test_the_code_makes_one_administrator_of_the_site(self, clinic):
        browser = clinic.browser()
        assert browser.get("/v1/sign-in").json() == {"first_run": True, "providers": []}
        answer = browser.post("/v1/first-run", json=self.body(clinic))
        assert answer.status_code == HTTPStatus.CREATED
        assert (answer.json()["role"], answer.json()["site_admin"]) == ("admin", True)
        assert browser.get("/v1/accounts").json()["total"] == 1
        assert not first_run.code_file(clinic.gateway.settings.own_dir).exists()
        again = clinic.browser().post("/v1/first-run", json=self.body(clinic, "second"))
        assert again.status_code == HTTPStatus.CONFLICT

    def test_without_the_code_nothing_is_computed(self, clinic, monkeypatch):
        monkeypatch.setattr(clinic.gateway.passwords, "keep", lambda _: pytest.fail("a stranger costs a hash"))
        body = self.body(clinic) | {"code": "AAAAAAAAAA"}
        assert clinic.browser().post("/v1/first-run", json=body).status_code == HTTPStatus.FORBIDDEN

    def test_a_weak_password_does_not_use_the_code_up(self, clinic):
        body = self.body(clinic, password="chief chief chief")
        assert clinic.browser().post("/v1/first-run", json=body).status_code == HTTPStatus.UNPROCESSABLE_ENTITY
        assert clinic.browser().post("/v1/first-run", json=self.body(clinic)).status_code == HTTPStatus.CREATED

    def test_two_at_once_make_one(self, clinic, monkeypatch):
        both, keep = threading.Barrier(2), clinic.gateway.passwords.keep

        def keep_together(password):
            both.wait(30)
            return keep(password)

        monkeypatch.setattr(clinic.gateway.passwords, "keep", keep_together)
        bodies, statuses = [self.body(clinic, login) for login in ("one", "two")], []

        def create(body):
            statuses.append(clinic.browser().post("/v1/first-run", json=body).status_code)

        threads = [threading.Thread(target=create, args=(body,)) for body in bodies]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert sorted(statuses) == [HTTPStatus.CREATED, HTTPStatus.CONFLICT]
        assert [login for login in ("one", "two") if clinic.find(login) is not None] != ["one", "two"]


class TestCookie:
    def held(self, clinic, base_url, headers=None):
        clinic.account("m.arnold")
        browser = TestClient(clinic.app, base_url=base_url, headers=headers)
        answer = sign_in(browser, "m.arnold")
        return answer.headers["set-cookie"]

    def test_in_clear_it_is_for_scripts_and_other_sites_out_of_reach(self, clinic):
        cookie = self.held(clinic, "http://testserver")
        assert cookie.startswith("ambula=")
        assert "HttpOnly" in cookie
        assert "SameSite=strict" in cookie
        assert "Path=/" in cookie
        assert "Secure" not in cookie
        assert "Max-Age" not in cookie

    def test_over_tls_no_plain_connection_carries_or_sets_it(self, clinic):
        cookie = self.held(clinic, "https://testserver")
        assert cookie.startswith("__Host-ambula=")
        assert "; Secure" in cookie

    def test_behind_a_proxy_the_public_address_decides(self, clinic):
        clinic.gateway.settings.public_url = "https://testserver"
        assert self.held(clinic, "http://testserver").startswith("__Host-ambula=")

    def test_beside_the_proxy_it_is_as_the_connection_is(self, clinic):
        clinic.gateway.settings.public_url = "https://gait.clinic.example"
        assert self.held(clinic, "http://testserver").startswith("ambula=")


def test_a_viewer_only_looks_on(clinic):
    browser = clinic.browser(Role.VIEWER)
    assert browser.get("/v1/patients").status_code == HTTPStatus.OK
    assert browser.post("/v1/patients", json={}).status_code == HTTPStatus.FORBIDDEN
