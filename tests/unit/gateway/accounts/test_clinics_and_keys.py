"""Clinics of the site, and the keys of their machines."""

from datetime import UTC, datetime, timedelta
from http import HTTPStatus

import pytest

from services.gateway.access.roles import Role
from services.gateway.access.scope import EVERYTHING
from services.gateway.access.tables import ApiKeyRow

UNPROCESSABLE = HTTPStatus.UNPROCESSABLE_ENTITY


@pytest.fixture
def admin(clinic):
    return clinic.browser(Role.ADMIN)


@pytest.fixture
def chief(clinic):
    return clinic.browser(Role.ADMIN, "main", "chief", site_admin=True)


class TestClinics:
    def test_the_site_has_several_each_managed_by_its_own(self, clinic, admin, chief):
        north = {"id": "north", "name": "Clinic in the north", "keep_days": 3650}
        assert chief.post("/v1/clinics", json=north).json().items() >= {**north, "accounts": 0}.items()
        assert chief.post("/v1/clinics", json=north).status_code == HTTPStatus.CONFLICT
        assert [each["id"] for each in chief.get("/v1/clinics").json()["items"]] == ["main", "north"]
        own = admin.get("/v1/clinics").json()
        assert (own["total"], own["items"][0]["id"], own["items"][0]["accounts"]) == (1, "main", 2)
        assert admin.post("/v1/clinics", json=north | {"id": "south"}).status_code == HTTPStatus.FORBIDDEN
        assert admin.patch("/v1/clinics/north", json={"name": "Ours"}).status_code == HTTPStatus.NOT_FOUND
        assert chief.patch("/v1/clinics/north", json={"name": "Far north"}).json()["name"] == "Far north"
        assert chief.patch("/v1/clinics/south", json={"name": "South"}).status_code == HTTPStatus.NOT_FOUND

    def test_how_long_recordings_are_kept_is_the_clinics_own(self, admin):
        assert admin.patch("/v1/clinics/main", json={"keep_days": 365}).json()["keep_days"] == 365
        assert admin.patch("/v1/clinics/main", json={"name": "Ward 3"}).json()["keep_days"] == 365
        assert admin.patch("/v1/clinics/main", json={"keep_days": None}).json()["keep_days"] is None
        for wrong in ({"keep_days": 0}, {"keep_days": -1}, {"name": ""}, {"name": None}, {"name": "a\nb"}, {"id": "x"}):
            assert admin.patch("/v1/clinics/main", json=wrong).status_code == UNPROCESSABLE, wrong


class TestKeys:
    def make(self, admin, **more):
        return admin.post("/v1/keys", json={"name": "hospital export", "role": "service", "days": 90} | more)

    def machine(self, clinic, text):
        browser = clinic.browser()
        browser.headers["authorization"] = f"Bearer {text}"
        return browser

    def test_a_key_is_shown_once_and_opens_what_its_role_may(self, clinic, admin):
        answer = self.make(admin)
        assert answer.status_code == HTTPStatus.CREATED
        made = answer.json()
        secret = made["key"].rpartition("_")[2]
        assert made["key"].split("_")[1] == made["id"]
        assert (made["created_by"], made["used"], made["revoked"]) == ("admin.main", None, None)
        machine = self.machine(clinic, made["key"])
        assert machine.get("/v1/patients").status_code == HTTPStatus.OK
        assert machine.post("/v1/patients", json={}).status_code == HTTPStatus.CREATED
        assert machine.get("/v1/keys").status_code == HTTPStatus.FORBIDDEN
        listed = admin.get("/v1/keys")
        assert listed.json()["items"][0]["used"] is not None
        assert secret not in listed.text
        with clinic.gateway.database.transaction(EVERYTHING) as database:
            assert secret not in str(vars(database.get_one(ApiKeyRow, made["id"])))
        assert secret not in str([vars(entry) for entry in clinic.audit()])

    def test_a_key_that_only_looks_on_changes_nothing(self, clinic, admin):
        machine = self.machine(clinic, self.make(admin, role="viewer").json()["key"])
        assert machine.get("/v1/patients").status_code == HTTPStatus.OK
        assert machine.post("/v1/patients", json={}).status_code == HTTPStatus.FORBIDDEN

    def test_a_key_that_was_taken_back_or_has_ended_is_nobodys(self, clinic, admin):
        made, other = self.make(admin).json(), self.make(admin).json()
        assert admin.delete(f"/v1/keys/{made['id']}").status_code == HTTPStatus.NO_CONTENT
        assert admin.delete(f"/v1/keys/{made['id']}").status_code == HTTPStatus.NO_CONTENT
        assert self.machine(clinic, made["key"]).get("/v1/me").status_code == HTTPStatus.UNAUTHORIZED
        assert self.machine(clinic, other["key"]).get("/v1/me").status_code == HTTPStatus.OK
        with clinic.gateway.database.transaction(EVERYTHING) as database:
            database.get_one(ApiKeyRow, other["id"]).expires = datetime.now(UTC)
        assert self.machine(clinic, other["key"]).get("/v1/me").status_code == HTTPStatus.UNAUTHORIZED
        assert admin.get("/v1/keys").json()["total"] == 2

    def test_another_clinics_keys_do_not_exist(self, clinic, admin, chief):
        made = self.make(admin).json()
        other = clinic.browser(Role.ADMIN, "north")
        assert other.get("/v1/keys").json() == {"total": 0, "items": []}
        assert other.delete(f"/v1/keys/{made['id']}").status_code == HTTPStatus.NOT_FOUND
        theirs = self.machine(clinic, self.make(other).json()["key"])
        code = admin.post("/v1/patients", json={}).json()["code"]
        assert theirs.get(f"/v1/patients/{code}").status_code == HTTPStatus.NOT_FOUND

    def test_what_is_no_key_is_not_made(self, admin):
        for wrong in ({"role": "admin"}, {"role": "therapist"}, {"days": 0}, {"days": 366}, {"name": ""}, {"more": 1}):
            assert self.make(admin, **wrong).status_code == UNPROCESSABLE, wrong
        ends = datetime.fromisoformat(self.make(admin, days=365).json()["expires"])
        assert ends - datetime.now(UTC) <= timedelta(days=365)

    def test_what_is_no_key_opens_nothing(self, clinic, admin):
        key = self.make(admin).json()["key"]
        for text in ("", key[:-1], key + "x", key.replace("ambula", "other"), key.rpartition("_")[0], "a_b_c", "_" * 9):
            assert self.machine(clinic, text).get("/v1/me").status_code == HTTPStatus.UNAUTHORIZED, text
        basic = clinic.browser()
        basic.headers["authorization"] = f"Basic {key}"
        assert basic.get("/v1/me").status_code == HTTPStatus.UNAUTHORIZED
