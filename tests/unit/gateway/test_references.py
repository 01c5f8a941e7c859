from http import HTTPStatus

import pytest

from tests.unit.gateway.comings import come, new_patient
from tests.unit.reference.folder import write_set


@pytest.fixture
def settings(settings, tmp_path):
    write_set(tmp_path / "clinic_sets")
    write_set(tmp_path / "clinic_sets", ["x,cm,,,,,,,1,1,,,,"], name="spoiled")
    return settings.model_copy(update={"references": str(tmp_path / "clinic_sets")})


def test_sets_are_listed_with_what_must_be_printed(client):
    page = client.get("/v1/references", params={"limit": 2}).json()
    assert page["total"] == 5
    first = page["items"][0]
    assert (first["name"], first["own"], first["version"], first["licence"]) == ("clinic", True, "3", "ours")
    assert first["strata"][0]["mean"] == 1.30
    assert page["refused"] == [{"folder": "spoiled", "where": "table.csv: line 2", "what": page["refused"][0]["what"]}]
    assert "unit" in page["refused"][0]["what"]


def test_a_session_is_set_against_people_like_the_patient(client, gateway):
    code = new_patient(client, year_of_birth=1996, sex="female")
    come(gateway, code, "walk", 0, 0.9)
    told = client.get("/v1/sessions/walk/references").json()
    assert (told["age"], told["sex"], told["speed"]) == (30, "female", 0.9)
    (speed,) = told["metrics"]
    assert (speed["measure"], speed["position"], speed["band"]["set_name"]) == ("walking_speed", "below", "clinic")


def test_who_is_not_known_has_no_band_but_a_reason(client, gateway):
    come(gateway, new_patient(client), "walk", 0, 0.9)
    (speed,) = client.get("/v1/sessions/walk/references").json()["metrics"]
    assert (speed["band"], speed["position"], speed["because"]) == (None, None, "age_unknown")
    assert client.get("/v1/sessions/nobody/references").status_code == HTTPStatus.NOT_FOUND
