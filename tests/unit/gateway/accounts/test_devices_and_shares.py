"""What a clinic measures with, and patients whom colleagues of other clinics may see."""

from http import HTTPStatus

import pytest

from services.gateway.access.roles import Role
from tests.unit.gateway.conftest import CAMERA

CONFLICT, FORBIDDEN, NOT_FOUND = HTTPStatus.CONFLICT, HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND


@pytest.fixture
def admin(clinic):
    return clinic.browser(Role.ADMIN)


@pytest.fixture
def other(clinic):
    """An administrator of another clinic."""
    return clinic.browser(Role.ADMIN, "north")


class TestDevices:
    def register(self, admin, **more):
        return admin.post("/v1/devices", json={"name": "Camera, hall", "kind": "camera", "source": CAMERA} | more)

    def offered(self, browser):
        return [each["id"] for each in browser.get("/v1/sources").json()["sources"]]

    def start(self, browser, source=CAMERA):
        return browser.post("/v1/sessions", json={"source": source}).status_code

    def test_a_registered_source_is_offered_to_its_clinic_alone(self, clinic, admin, other, control):
        assert CAMERA in self.offered(admin)
        assert CAMERA in self.offered(other)
        made = self.register(admin).json()
        assert CAMERA in self.offered(clinic.browser(Role.VIEWER))
        assert CAMERA not in self.offered(other)
        for source in (CAMERA, f"{CAMERA}&height=1.71"):
            assert self.start(other, source) == HTTPStatus.UNPROCESSABLE_ENTITY
        assert control.started == []
        assert self.start(admin) == HTTPStatus.CREATED
        assert admin.patch(f"/v1/devices/{made['id']}", json={"retired": True}).json()["retired"] is not None
        assert CAMERA in self.offered(other)
        assert self.start(other) == HTTPStatus.CREATED

    def test_a_source_belongs_to_one_device(self, admin, other):
        made = self.register(admin).json()
        assert self.register(admin).status_code == CONFLICT
        assert self.register(other).status_code == CONFLICT
        assert admin.patch(f"/v1/devices/{made['id']}", json={"name": "Camera, gym"}).json()["source"] == CAMERA
        admin.patch(f"/v1/devices/{made['id']}", json={"retired": True})
        theirs = self.register(other).json()
        assert admin.patch(f"/v1/devices/{made['id']}", json={"retired": False}).status_code == CONFLICT
        assert other.patch(f"/v1/devices/{theirs['id']}", json={"source": None}).json()["source"] is None
        assert admin.patch(f"/v1/devices/{made['id']}", json={"retired": False}).json()["retired"] is None

    def test_therapists_see_the_register_and_administrators_keep_it(self, clinic, admin, other):
        made = self.register(admin, kind="sensor_set", source=None, name="Set B", note="strap mended").json()
        therapist = clinic.browser(Role.THERAPIST)
        assert therapist.get("/v1/devices").json() == {"total": 1, "items": [made]}
        assert self.register(therapist, source=None).status_code == FORBIDDEN
        assert therapist.patch(f"/v1/devices/{made['id']}", json={"note": None}).status_code == FORBIDDEN
        assert other.get("/v1/devices").json()["total"] == 0
        assert other.patch(f"/v1/devices/{made['id']}", json={"name": "Ours"}).status_code == NOT_FOUND
        for wrong in (
            {"source": "/dev/video0"},
            {"source": "device:a b"},
            {"kind": "other"},
            {"name": ""},
            {"id": "a"},
        ):
            assert self.register(admin, **wrong).status_code == HTTPStatus.UNPROCESSABLE_ENTITY, wrong


class TestShares:
    @pytest.fixture
    def therapist(self, clinic):
        return clinic.browser(Role.THERAPIST)

    @pytest.fixture
    def colleague(self, clinic):
        return clinic.browser(Role.THERAPIST, "north", "colleague")

    @pytest.fixture
    def code(self, therapist):
        return therapist.post("/v1/patients", json={"year_of_birth": 1957}).json()["code"]

    def share(self, browser, code, colleague):
        return browser.post(f"/v1/patients/{code}/shares", json={"account": colleague.account})

    def test_a_colleague_is_found_by_the_whole_name_alone(self, therapist, colleague, clinic):
        found = therapist.get("/v1/colleagues?login=COLLEAGUE").json()
        assert found == {
            "account": colleague.account, "login": "colleague", "role": "therapist", "clinic": "north",
            "clinic_name": "North",
        }  # fmt: skip
        clinic.change(clinic.account("closed", clinic="north"), disabled=True)
        for login in ("colleagu", "c%", "_olleague", "nobody", "closed", "therapist.main"):
            assert therapist.get("/v1/colleagues", params={"login": login}).status_code == NOT_FOUND, login
        assert clinic.browser(Role.VIEWER).get("/v1/colleagues?login=colleague").status_code == FORBIDDEN

    def test_a_shared_patient_is_seen_by_the_colleague_and_nobody_else_until_it_ends(
        self, clinic, therapist, colleague, code
    ):
        bystander = clinic.browser(Role.THERAPIST, "north")
        granting = (therapist.account, code, f"account={colleague.account}")
        path = f"/v1/patients/{code}"
        assert colleague.get(path).status_code == NOT_FOUND
        made = self.share(therapist, code, colleague)
        assert (made.status_code, made.json()["granted_by"]) == (HTTPStatus.CREATED, "therapist.main")
        assert self.share(therapist, code, colleague).json() == made.json()
        assert therapist.get(f"{path}/shares").json() == {"items": [made.json()]}
        assert colleague.get(path).json()["year_of_birth"] == 1957
        assert bystander.get(path).status_code == NOT_FOUND
        assert therapist.delete(f"{path}/shares/{colleague.account}").status_code == HTTPStatus.NO_CONTENT
        assert colleague.get(path).status_code == NOT_FOUND
        assert therapist.delete(f"{path}/shares/{colleague.account}").status_code == NOT_FOUND
        told = [(each.actor, each.patient, each.object) for each in clinic.audit() if "share" in each.action]
        assert told.count(granting) == 4, "given twice, ended, and once more in vain"

    def test_who_a_patient_was_shared_with_does_not_share_them_on(self, clinic, therapist, colleague, code):
        self.share(therapist, code, colleague)
        third = clinic.browser(Role.THERAPIST, "south", "third")
        assert self.share(colleague, code, third).status_code == FORBIDDEN
        assert colleague.get(f"/v1/patients/{code}/shares").status_code == FORBIDDEN
        own = colleague.delete(f"/v1/patients/{code}/shares/{colleague.account}")
        assert own.status_code == FORBIDDEN
        assert third.get(f"/v1/patients/{code}").status_code == NOT_FOUND

    def test_what_can_not_be_shared(self, clinic, therapist, colleague, code, other):
        mine = clinic.browser(Role.VIEWER)
        assert self.share(therapist, code, mine).status_code == CONFLICT
        assert self.share(mine, code, colleague).status_code == FORBIDDEN
        assert self.share(other, code, colleague).status_code == NOT_FOUND
        assert self.share(therapist, "2222", colleague).status_code == NOT_FOUND
        nobody = therapist.post(f"/v1/patients/{code}/shares", json={"account": "0" * 16})
        assert nobody.status_code == NOT_FOUND
        clinic.change(colleague.account, disabled=True)
        assert self.share(therapist, code, colleague).status_code == NOT_FOUND

    def test_a_machine_shares_with_nobody(self, clinic, admin, colleague, code):
        made = admin.post("/v1/keys", json={"name": "export", "role": "service", "days": 1}).json()
        machine = clinic.browser()
        machine.headers["authorization"] = f"Bearer {made['key']}"
        assert self.share(machine, code, colleague).status_code == FORBIDDEN
        assert machine.get("/v1/colleagues?login=colleague").status_code == FORBIDDEN
        assert machine.get(f"/v1/patients/{code}").status_code == HTTPStatus.OK
