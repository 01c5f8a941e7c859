"""What is deleted is away, can be brought back exactly as it was, and says when it goes for good."""

from datetime import UTC, datetime, timedelta

import pytest

from services.gateway.access.roles import Role
from services.gateway.access.scope import EVERYTHING
from services.gateway.access.tables import ShareRow
from services.gateway.tables import PatientRow
from tests.unit.gateway import people


@pytest.fixture
def patient(client):
    return client.post("/v1/patients", json={}).json()["code"]


@pytest.fixture
def walk(client, gateway, made, patient):
    """Sessions of the patient that are over."""

    def walk(session, code=patient):
        gateway.keeper.appeared(made.describe(session))
        gateway.keeper.measured(session, made.metrics_at(30.0, final=True))
        if code is not None:
            client.patch(f"/v1/sessions/{session}", json={"patient": code})

    return walk


def there(client):
    sessions = client.get("/v1/sessions").json()["items"]
    patients = client.get("/v1/patients").json()["items"]
    return {each["id"] for each in sessions} | {each["code"] for each in patients}


def in_bin(client):
    found = client.get("/v1/bin").json()
    return {each["code"]: each["sessions"] for each in found["patients"]}, [each["id"] for each in found["sessions"]]


def test_a_patient_goes_with_the_sessions_and_comes_back_with_exactly_those(client, walk, patient):
    for session in ("a", "b", "c"):
        walk(session)
    walk("other", None)
    assert client.delete("/v1/sessions/a").status_code == 204
    assert client.delete(f"/v1/patients/{patient}").status_code == 204
    assert there(client) == {"other"}
    assert in_bin(client) == ({patient: 2}, ["a"])
    for path in (f"patients/{patient}", "sessions/b", "sessions/b/metrics", f"patients/{patient}/treatments"):
        assert client.get(f"/v1/{path}").status_code == 404
    assert client.post("/v1/bin/sessions/a/restoration").status_code == 409
    restored = client.post(f"/v1/bin/patients/{patient}/restoration").json()
    assert restored == {"patient": patient, "sessions": 2}
    assert there(client) == {"other", patient, "b", "c"}
    assert client.post("/v1/bin/sessions/a/restoration").json() == {"patient": patient, "sessions": 1}
    assert there(client) == {"other", patient, "a", "b", "c"}
    assert in_bin(client) == ({}, [])
    assert client.get("/v1/sessions/a/metrics").status_code == 200


def test_the_bin_says_on_which_day_it_is_erased(client, walk, patient):
    walk("a")
    client.delete("/v1/sessions/a")
    client.delete(f"/v1/patients/{patient}")
    found = client.get("/v1/bin").json()
    day = (datetime.now(UTC) + timedelta(days=found["keep_days"])).date().isoformat()
    assert [each["erased_on"] for each in (*found["patients"], *found["sessions"])] == [day, day]


def test_what_runs_is_not_deleted(client, gateway, made, patient):
    gateway.keeper.appeared(made.describe("a"))
    client.patch("/v1/sessions/a", json={"patient": patient})
    for path in ("sessions/a", f"patients/{patient}"):
        answer = client.delete(f"/v1/{path}")
        assert (answer.status_code, answer.json()["detail"]) == (409, "Session a still runs.")
    assert there(client) == {"a", patient}


def test_what_is_not_there_is_told(client):
    assert client.delete("/v1/patients/NONE").status_code == 404
    assert client.delete("/v1/sessions/none").status_code == 404
    assert client.post("/v1/bin/patients/NONE/restoration").status_code == 404
    assert client.post("/v1/bin/sessions/none/restoration").status_code == 404


def test_deleting_again_does_not_begin_anew(client, walk, patient):
    walk("a")
    client.delete(f"/v1/patients/{patient}")
    assert client.delete(f"/v1/patients/{patient}").status_code == 404
    assert client.delete("/v1/sessions/a").status_code == 404


def test_another_clinic_deletes_nothing_and_sees_no_bin(client, gateway, walk, patient):
    walk("a")
    guest = people.sign_in(client, Role.ADMIN, "other")
    assert client.delete(f"/v1/patients/{patient}").status_code == 404
    with gateway.database.transaction(EVERYTHING) as database:
        database.add(ShareRow(patient_code=patient, account_id=guest, granted_by=None, granted=datetime.now(UTC)))
    assert client.delete(f"/v1/patients/{patient}").status_code == 403
    assert client.delete("/v1/sessions/a").status_code == 403
    assert there(client) == {"a", patient}
    people.sign_in(client, Role.ADMIN)
    client.delete(f"/v1/patients/{patient}")
    people.sign_in(client, Role.ADMIN, "other")
    assert in_bin(client) == ({}, [])
    assert client.post(f"/v1/bin/patients/{patient}/restoration").status_code == 404
    with gateway.database.transaction(EVERYTHING) as database:
        assert database.get(PatientRow, patient).deleted is not None
