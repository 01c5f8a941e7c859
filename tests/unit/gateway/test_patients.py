from http import HTTPStatus

import pytest

from services.gateway.patients import records


def test_a_patient_gets_a_random_code_and_nothing_else(client):
    first = client.post("/v1/patients", json={"year_of_birth": 1957}).json()
    second = client.post("/v1/patients", json={}).json()
    assert len(first["code"]) == records.CODE_LENGTH
    assert set(first["code"]) <= set(records.ALPHABET)
    assert first["code"] != second["code"]
    assert (first["year_of_birth"], second["year_of_birth"]) == (1957, None)
    assert set(first) == {
        "code", "year_of_birth", "sex", "population", "paretic_side", "created", "sessions"
    }  # fmt: skip


def test_patients_are_listed_newest_first_in_pages(client):
    codes = [client.post("/v1/patients", json={}).json()["code"] for _ in range(3)]
    page = client.get("/v1/patients", params={"limit": 2}).json()
    assert page["total"] == 3
    assert [patient["code"] for patient in page["items"]] == codes[:0:-1]
    rest = client.get("/v1/patients", params={"limit": 2, "offset": 2}).json()
    assert [patient["code"] for patient in rest["items"]] == codes[:1]


def test_the_year_of_birth_can_be_corrected_and_taken_out(client):
    path = f"/v1/patients/{client.post('/v1/patients', json={'year_of_birth': 1957}).json()['code']}"
    assert client.patch(path, json={"year_of_birth": 1958}).json()["year_of_birth"] == 1958
    assert client.patch(path, json={"year_of_birth": None}).json()["year_of_birth"] is None
    assert client.get(path).json()["year_of_birth"] is None


@pytest.mark.parametrize("body", [{"name": "Jane"}, {"code": "ABC"}, {"year_of_birth": 1492}, {"year_of_birth": "x"}])
def test_nothing_else_is_taken(client, body):
    answer = client.post("/v1/patients", json=body)
    assert answer.status_code == HTTPStatus.UNPROCESSABLE_ENTITY
    assert answer.json()["faults"][0]["where"].startswith("body.")
    assert client.get("/v1/patients").json()["total"] == 0


def test_an_unknown_patient_is_a_problem_with_a_next_step(client):
    for answer in (
        client.get("/v1/patients/NOBODY"),
        client.patch("/v1/patients/NOBODY", json={"year_of_birth": 1950}),
    ):
        assert answer.status_code == HTTPStatus.NOT_FOUND
        assert answer.headers["content-type"] == "application/problem+json"
        assert "GET /v1/patients" in answer.json()["next_step"]


@pytest.mark.parametrize("query", [{"limit": 101}, {"limit": 0}, {"offset": -1}])
def test_pages_are_bounded(client, query):
    assert client.get("/v1/patients", params=query).status_code == HTTPStatus.UNPROCESSABLE_ENTITY


def test_a_drawn_code_that_exists_is_drawn_again(client, monkeypatch):
    taken = client.post("/v1/patients", json={}).json()["code"]
    codes = iter([taken, taken, "FRESH2"])
    monkeypatch.setattr(records, "_random_code", lambda: next(codes))
    assert client.post("/v1/patients", json={}).json()["code"] == "FRESH2"
