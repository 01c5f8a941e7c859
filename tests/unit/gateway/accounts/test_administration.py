"""Who may manage whose account."""

import threading
from http import HTTPStatus

import pytest

from services.gateway.access.caller import Caller
from services.gateway.access.roles import Role
from services.gateway.access.scope import EVERYTHING
from services.gateway.access.tables import AccountRow
from services.gateway.accounts import administering, records
from services.gateway.accounts.account_models import AccountChange
from services.gateway.problems import Problem

PASSWORD, NEXT = "three quiet steps", "seven slow strides"
CREATED, FORBIDDEN, CONFLICT, NOT_FOUND = (
    HTTPStatus.CREATED,
    HTTPStatus.FORBIDDEN,
    HTTPStatus.CONFLICT,
    HTTPStatus.NOT_FOUND,
)


@pytest.fixture
def people(clinic):
    """A therapist and an administrator each of two clinics, and the administrator of the site."""

    class People:
        therapist = clinic.browser(Role.THERAPIST)
        admin = clinic.browser(Role.ADMIN)
        other = clinic.browser(Role.ADMIN, "north")
        theirs = clinic.browser(Role.THERAPIST, "north")
        chief = clinic.browser(Role.ADMIN, "main", "chief", site_admin=True)

    return People


def new(login="m.arnold", role="therapist", **more):
    return {"login": login, "role": role, "password": PASSWORD} | more


def test_an_administrator_makes_accounts_of_the_own_clinic(people, clinic):
    answer = people.admin.post("/v1/accounts", json=new())
    assert answer.status_code == CREATED
    made = answer.json()
    assert {name: made[name] for name in ("login", "role", "clinic", "site_admin", "disabled", "provider")} == {
        "login": "m.arnold", "role": "therapist", "clinic": "main", "site_admin": False, "disabled": False,
        "provider": None,
    }  # fmt: skip
    assert PASSWORD not in answer.text
    assert "argon2" not in answer.text
    browser = clinic.browser()
    assert browser.post("/v1/sign-in", json={"login": "m.arnold", "password": PASSWORD}).status_code == HTTPStatus.OK
    assert people.admin.post("/v1/accounts", json=new("M.Arnold")).status_code == CONFLICT
    listed = people.admin.get("/v1/accounts").json()
    assert [each["login"] for each in listed["items"]] == ["admin.main", "chief", "m.arnold", "therapist.main"]
    assert (listed["total"], listed["items"][2]["browsers"]) == (4, 1)


def test_administrators_of_the_site_have_all_clinics(people):
    answer = people.chief.post("/v1/accounts", json=new(clinic="north", role="admin", site_admin=True))
    assert (answer.status_code, answer.json()["clinic"], answer.json()["site_admin"]) == (CREATED, "north", True)
    assert people.chief.get("/v1/accounts?limit=2&offset=1").json()["total"] == 6
    assert people.chief.post("/v1/accounts", json=new("x", clinic="nowhere")).status_code == CONFLICT
    moved = people.chief.patch(f"/v1/accounts/{people.theirs.account}", json={"clinic": "main"})
    assert moved.json()["clinic"] == "main"
    assert people.theirs.get("/v1/me").json()["clinic"] == "main"


def test_administrators_of_a_clinic_do_not_reach_beyond_it(people):
    foreign, chief, own = people.theirs.account, people.chief.account, people.therapist.account
    for method, path, body, status in (
        ("POST", "/v1/accounts", new(clinic="north"), FORBIDDEN),
        ("POST", "/v1/accounts", new(role="admin", site_admin=True), FORBIDDEN),
        ("PATCH", f"/v1/accounts/{foreign}", {"disabled": True}, NOT_FOUND),
        ("PUT", f"/v1/accounts/{foreign}/password", {"password": NEXT}, NOT_FOUND),
        ("PATCH", f"/v1/accounts/{chief}", {"disabled": True}, FORBIDDEN),
        ("PUT", f"/v1/accounts/{chief}/password", {"password": NEXT}, FORBIDDEN),
        ("PATCH", f"/v1/accounts/{own}", {"clinic": "north"}, FORBIDDEN),
        ("PATCH", f"/v1/accounts/{own}", {"role": "admin", "site_admin": True}, FORBIDDEN),
        ("PATCH", "/v1/accounts/0000", {"disabled": True}, NOT_FOUND),
    ):
        assert people.admin.request(method, path, json=body).status_code == status, (method, path, body)
    assert people.theirs.get("/v1/me").status_code == HTTPStatus.OK


NO_ACCOUNTS = (
    new(role="service"),
    new(login="ü"),
    new(login=""),
    new(password="short"),
    new(password=None),
    new(password="m.arnold m.arnold"),
    new(provider="x"),
    new(more=1),
    {"login": "m.arnold", "role": "viewer"},
)


def test_what_is_no_account_is_not_made(people, clinic):
    for body in NO_ACCOUNTS:
        assert people.admin.post("/v1/accounts", json=body).status_code == HTTPStatus.UNPROCESSABLE_ENTITY, body
    assert clinic.find("m.arnold") is None


def test_a_service_that_is_not_set_up_knows_nobody(people):
    body = {"login": "m.arnold", "role": "viewer", "provider": "hospital"}
    assert people.admin.post("/v1/accounts", json=body).status_code == CONFLICT


def test_a_closed_account_is_signed_out_and_stays_out(people):
    path = f"/v1/accounts/{people.therapist.account}"
    assert people.admin.patch(path, json={"disabled": True}).json()["disabled"] is True
    assert people.therapist.get("/v1/me").status_code == HTTPStatus.UNAUTHORIZED
    assert people.admin.patch(path, json={"disabled": False}).json()["browsers"] == 0
    assert people.therapist.get("/v1/me").status_code == HTTPStatus.UNAUTHORIZED


def test_another_role_counts_from_the_next_request(people):
    path = f"/v1/accounts/{people.therapist.account}"
    assert people.admin.patch(path, json={"role": "viewer"}).json()["role"] == "viewer"
    assert people.therapist.post("/v1/patients", json={}).status_code == FORBIDDEN
    assert people.admin.patch(path, json={"role": None, "disabled": None}).json()["role"] == "viewer"


def test_a_password_from_the_administrator_signs_out_and_opens_what_guessing_closed(people, clinic):
    account = clinic.account("m.arnold")
    owner = clinic.browser()
    owner.post("/v1/sign-in", json={"login": "m.arnold", "password": PASSWORD})
    for _ in range(clinic.gateway.parameters.free_failures + 1):
        clinic.browser().post("/v1/sign-in", json={"login": "m.arnold", "password": "wrong"})
    items = people.admin.get("/v1/accounts").json()["items"]
    assert next(each for each in items if each["id"] == account)["locked_until"] is not None
    answer = people.admin.put(f"/v1/accounts/{account}/password", json={"password": NEXT})
    assert answer.status_code == HTTPStatus.NO_CONTENT
    assert owner.get("/v1/me").status_code == HTTPStatus.UNAUTHORIZED
    again = clinic.browser().post("/v1/sign-in", json={"login": "m.arnold", "password": NEXT})
    assert again.status_code == HTTPStatus.OK
    weak = people.admin.put(f"/v1/accounts/{account}/password", json={"password": "m.arnold m.arnold"})
    assert weak.status_code == HTTPStatus.UNPROCESSABLE_ENTITY
    # The therapist of the fixture has no password of their own: they sign in elsewhere.
    elsewhere = people.admin.put(f"/v1/accounts/{people.therapist.account}/password", json={"password": NEXT})
    assert elsewhere.status_code == CONFLICT


def test_the_audit_has_who_was_given_what(people, clinic):
    made = people.chief.post("/v1/accounts", json=new()).json()["id"]
    people.chief.patch(f"/v1/accounts/{made}", json={"role": "admin", "clinic": None})
    people.chief.put(f"/v1/accounts/{made}/password", json={"password": NEXT})
    told = [(each.action, each.object) for each in clinic.audit() if each.actor == people.chief.account]
    assert told == [
        ("create_account", f"account={made} role=therapist clinic=main site_admin=False"),
        ("change_account", f"account={made} role=admin"),
        ("set_password", f"account={made}"),
    ]


def test_nobody_changes_their_own_account(people):
    for browser in (people.admin, people.chief):
        for body in ({"disabled": True}, {"role": "viewer"}, {"site_admin": False}):
            assert browser.patch(f"/v1/accounts/{browser.account}", json=body).status_code == CONFLICT
        own = browser.put(f"/v1/accounts/{browser.account}/password", json={"password": NEXT})
        assert own.status_code == CONFLICT
        assert browser.get("/v1/me").json()["role"] == "admin"


def test_an_administrator_of_the_site_stays_one_in_role(people, clinic):
    second = clinic.browser(Role.ADMIN, "main", "second", site_admin=True)
    path = f"/v1/accounts/{second.account}"
    assert people.chief.patch(path, json={"role": "viewer"}).status_code == CONFLICT
    assert people.chief.patch(path, json={"role": "viewer", "site_admin": False}).json()["role"] == "viewer"
    assert people.chief.patch(path, json={"site_admin": True}).status_code == CONFLICT


@pytest.mark.parametrize("body", [{"disabled": True}, {"role": "viewer", "site_admin": False}])
def test_two_that_remove_each_other_leave_one(people, clinic, body, monkeypatch):
    second = clinic.browser(Role.ADMIN, "main", "second", site_admin=True)
    both, waited = threading.Barrier(2), records.one_at_a_time

    def together(database):
        both.wait(30)
        waited(database)

    monkeypatch.setattr(records, "one_at_a_time", together)
    statuses = []

    def remove(browser, account):
        statuses.append(browser.patch(f"/v1/accounts/{account}", json=body).status_code)

    threads = [
        threading.Thread(target=remove, args=pair)
        for pair in ((people.chief, second.account), (second, people.chief.account))
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert HTTPStatus.OK in statuses
    assert sorted(statuses)[1] in (FORBIDDEN, CONFLICT)
    with clinic.gateway.database.transaction(EVERYTHING) as database:
        assert records.count_site_admins(database) == 1


def test_the_last_administrator_of_the_site_stays(people, clinic):
    # No request gets this far, as nobody changes their own account; the rule stands by itself.
    caller = Caller("person", "other", "other", Role.ADMIN, "main", site_admin=True)

    def close_the_last():
        with clinic.gateway.database.transaction(EVERYTHING) as database:
            chief = database.get_one(AccountRow, people.chief.account)
            administering.change(database, caller, chief, AccountChange(disabled=True))

    with pytest.raises(Problem, match="last administrator"):
        close_the_last()
    assert people.chief.get("/v1/me").status_code == HTTPStatus.OK
