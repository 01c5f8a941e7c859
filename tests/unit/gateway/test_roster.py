from http import HTTPStatus

import pytest

from services.gateway.access.roles import Role
from tests.unit.gateway.comings import come, come_often, new_patient
from tests.unit.gateway.people import sign_in


@pytest.fixture
def came(client, gateway):
    code = new_patient(client)
    come_often(gateway, code, 0.5, 0.55, 0.72)
    come(gateway, code, "again", 28, 0.7, hours=2)
    return code


def roster(client, **query):
    return client.get("/v1/roster", params=query).json()


def test_the_list_tells_visits_and_how_the_patient_stands(client, came):
    client.get(f"/v1/patients/{came}/progress")
    (entry,) = roster(client)["items"]
    assert (entry["code"], entry["visits"], entry["sessions"], entry["shared"]) == (came, 3, 4, False)
    assert entry["last_visit"].startswith("2026-09-29T11:00")
    standing = entry["standing"]
    assert (standing["task"], standing["measure"], standing["verdict"], standing["direction"]) == (
        "walk", "walking_speed", "real_change", "better",
    )  # fmt: skip


def test_a_list_freezes_no_baseline(client, came):
    assert roster(client)["items"][0]["standing"] is None
    stored = client.get(f"/v1/patients/{came}/baseline").json()
    assert stored["visit"] == 1
    assert roster(client)["items"][0]["standing"] is not None


def test_who_came_or_was_registered_last_is_first(client, came):
    new = [new_patient(client, population="parkinson") for _ in range(2)]
    page = roster(client, limit=2)
    assert page["total"] == 3
    assert [entry["code"] for entry in page["items"]] == new[::-1]
    assert [(entry["visits"], entry["last_visit"]) for entry in page["items"]] == [(0, None)] * 2
    assert [entry["code"] for entry in roster(client, limit=2, offset=2)["items"]] == [came]


def test_it_can_be_searched_by_code_and_narrowed_to_a_group(client, came):
    other = new_patient(client, population="parkinson")
    assert came in [entry["code"] for entry in roster(client, search=came[1:4].lower())["items"]]
    assert [entry["code"] for entry in roster(client, search=came)["items"]] == [came]
    assert [entry["code"] for entry in roster(client, population="parkinson")["items"]] == [other]
    assert [entry["code"] for entry in roster(client, code=[other, "NOBODY"])["items"]] == [other]
    assert client.get("/v1/roster", params={"search": "%"}).status_code == HTTPStatus.UNPROCESSABLE_ENTITY


def test_another_clinic_s_patients_are_not_in_it(client, came):
    sign_in(client, Role.THERAPIST, clinic="other")
    assert roster(client) == {"total": 0, "items": []}
