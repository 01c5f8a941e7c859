from http import HTTPStatus

import pytest

from services.gateway.access.scope import EVERYTHING
from services.gateway.progress import records
from services.progress.baseline import freeze
from tests.unit.gateway.comings import come, come_often, new_patient


@pytest.fixture
def code(client, gateway):
    patient = new_patient(client)
    come_often(gateway, patient, 0.5, 0.55, 0.72)
    return patient


def speed_of(client, code, **query):
    answer = client.get(f"/v1/patients/{code}/progress", params=query).json()
    return next(each for each in answer["series"] if each["measure"] == "walking_speed")


def test_visits_are_listed_newest_first_with_their_headlines(client, gateway, code):
    come(gateway, code, "again", 28, 0.7, hours=2)
    page = client.get(f"/v1/patients/{code}/visits", params={"limit": 2}).json()
    assert page["total"] == 3
    assert [(visit["visit"], visit["day"], len(visit["sessions"])) for visit in page["items"]] == [
        (3, "2026-09-29", 2), (2, "2026-09-15", 1),
    ]  # fmt: skip
    first = page["items"][0]["sessions"][0]
    assert (first["session"], first["task"], first["conditions"]["aid"], first["usable"]) == (
        "s2",
        "walk",
        "none",
        True,
    )
    assert [(each["name"], each["value"]) for each in first["metrics"]] == [("walking_speed", 0.72)]
    rest = client.get(f"/v1/patients/{code}/visits", params={"offset": 2}).json()
    assert [visit["visit"] for visit in rest["items"]] == [1]


def test_a_real_change_comes_with_interval_threshold_and_rule(client, code):
    speed = speed_of(client, code)
    assert (speed["verdict"], speed["direction"]) == ("real_change", "better")
    assert speed["change"]["value"] == pytest.approx(0.22)
    assert (speed["mdc"]["value"], speed["mdc"]["above"], speed["mdc"]["below"]) == (0.15, 0.4, 0.8)
    (rule,) = speed["rules"]
    assert rule["code"] == "change_beyond_mdc"
    assert rule["parameters"]["mdc"] == 0.15
    assert rule["parameters"]["low"] == speed["change"]["low"] > 0.15
    assert [each["verdict"] for each in speed["visits"]] == ["cannot_tell", "within_measurement_error", "real_change"]


def test_joints_stand_beside_speed(client, code):
    (joint,) = client.get(f"/v1/patients/{code}/progress").json()["joint_recovery"]
    assert (joint["joint"], joint["word"], len(joint["visits"])) == ("knee_flexion", "recovery", 3)


def test_one_task_or_some_measures_can_be_asked_for(client, code):
    assert client.get(f"/v1/patients/{code}/progress", params={"task": "timed_up_and_go"}).json()["series"] == []
    assert speed_of(client, code, task="walk")["verdict"] == "real_change"
    chosen = client.get(f"/v1/patients/{code}/progress", params={"measure": ["walking_speed", "cadence"]}).json()
    assert [each["measure"] for each in chosen["series"]] == ["walking_speed"]
    none = client.get(f"/v1/patients/{code}/progress", params={"measure": "cadence"}).json()
    assert none["series"] == []
    assert none["joint_recovery"][0]["word"] == "recovery"
    wrong = client.get(f"/v1/patients/{code}/progress", params={"task": "dance"})
    assert wrong.status_code == HTTPStatus.UNPROCESSABLE_ENTITY


def test_the_first_usable_visit_is_frozen_when_progress_is_read(client, gateway, code):
    speed_of(client, code)
    baseline = client.get(f"/v1/patients/{code}/baseline").json()
    assert (baseline["visit"], baseline["chosen"], baseline["population"]) == (1, False, "stroke_chronic")
    assert baseline["tests"][0]["speed"] == 0.5
    assert baseline["references"]["mobbs_2025"] == "1"
    # An earlier session that is linked later does not take its place.
    come(gateway, code, "before", -14, 0.3)
    assert client.get(f"/v1/patients/{code}/baseline").json()["session"] == "s0"
    assert speed_of(client, code)["mdc"]["value"] == 0.15
    assert client.get(f"/v1/patients/{code}/visits").json()["items"][2]["baseline"]


def test_another_baseline_can_be_chosen_and_forgotten(client, code):
    answer = client.put(f"/v1/patients/{code}/baseline", json={"session": "s1"})
    assert (answer.json()["visit"], answer.json()["chosen"]) == (2, True)
    assert speed_of(client, code)["change"]["value"] == pytest.approx(0.17)
    assert client.delete(f"/v1/patients/{code}/baseline").status_code == HTTPStatus.NO_CONTENT
    assert speed_of(client, code)["change"]["value"] == pytest.approx(0.22)
    assert client.delete(f"/v1/patients/{code}/baseline").status_code == HTTPStatus.NO_CONTENT
    assert client.delete(f"/v1/patients/{code}/baseline").status_code == HTTPStatus.NOT_FOUND


def test_a_baseline_is_a_session_of_the_patient_and_usable(client, gateway, code):
    other = new_patient(client)
    come(gateway, other, "other", 0, 0.5, grade="poor")
    path = f"/v1/patients/{code}/baseline"
    assert client.put(path, json={"session": "other"}).status_code == HTTPStatus.NOT_FOUND
    unusable = client.put(f"/v1/patients/{other}/baseline", json={"session": "other"})
    assert unusable.status_code == HTTPStatus.CONFLICT
    assert "aid" in unusable.json()["next_step"]
    assert client.get(f"/v1/patients/{other}/baseline").status_code == HTTPStatus.NOT_FOUND
    assert client.put(path, json={"session": "s1", "why": "x"}).status_code == HTTPStatus.UNPROCESSABLE_ENTITY


def test_a_baseline_whose_session_was_another_patients_is_forgotten(client, code):
    client.put(f"/v1/patients/{code}/baseline", json={"session": "s1"})
    client.patch("/v1/sessions/s1", json={"patient": None})
    assert client.get(f"/v1/patients/{code}/baseline").json()["session"] == "s0"


def test_two_who_ask_at_once_get_the_same_baseline(client, gateway, code, monkeypatch):
    def frozen_meanwhile(visits, *others):
        monkeypatch.setattr(records, "freeze", freeze)
        with gateway.database.transaction(EVERYTHING) as database:
            records.keep_baseline(database, code, freeze(visits, "s1", *others[1:]))
        return freeze(visits, *others)

    monkeypatch.setattr(records, "freeze", frozen_meanwhile)
    assert client.get(f"/v1/patients/{code}/baseline").json()["session"] == "s1"


def test_without_sessions_there_is_nothing_to_say(client):
    code = new_patient(client)
    assert client.get(f"/v1/patients/{code}/visits").json() == {"total": 0, "items": []}
    answer = client.get(f"/v1/patients/{code}/progress").json()
    assert (answer["series"], answer["joint_recovery"], answer["curve_distance"]) == ([], [], [])
    for path in ("visits", "progress", "baseline", "treatments"):
        missing = client.get(f"/v1/patients/NOBODY/{path}")
        assert missing.status_code == HTTPStatus.NOT_FOUND
        assert missing.headers["content-type"] == "application/problem+json"


def test_treatments_are_marks_from_a_fixed_list(client):
    path = f"/v1/patients/{new_patient(client)}/treatments"
    later = client.post(path, json={"date": "2026-10-02", "kind": "botulinum_toxin"})
    client.post(path, json={"date": "2026-09-20", "kind": "gait_training"})
    assert later.status_code == HTTPStatus.CREATED
    assert [each["kind"] for each in client.get(path).json()["items"]] == ["botulinum_toxin", "gait_training"]
    assert client.get(path, params={"limit": 1, "offset": 1}).json()["items"][0]["date"] == "2026-09-20"
    for body in ({"date": "2026-10-02", "kind": "a talk"}, {"date": "soon", "kind": "surgery"},
                 {"date": "2026-10-02", "kind": "surgery", "note": "x"}):  # fmt: skip
        assert client.post(path, json=body).status_code == HTTPStatus.UNPROCESSABLE_ENTITY
    number = later.json()["id"]
    stranger = f"/v1/patients/{new_patient(client)}/treatments/{number}"
    assert client.delete(stranger).status_code == HTTPStatus.NOT_FOUND
    assert client.delete(f"{path}/{number}").status_code == HTTPStatus.NO_CONTENT
    assert client.get(path).json()["total"] == 1


def test_sessions_are_found_by_day_and_task(client, code):
    for query, sessions in (
        ({"from": "2026-09-15"}, ["s2", "s1"]),
        ({"to": "2026-09-15"}, ["s1", "s0"]),
        ({"from": "2026-09-02", "to": "2026-09-28"}, ["s1"]),
        ({"to": "9999-12-31", "from": "0001-01-01"}, ["s2", "s1", "s0"]),
        ({"task": "walk", "state": "finished"}, ["s2", "s1", "s0"]),
        ({"task": "squat"}, []),
    ):
        page = client.get("/v1/sessions", params=query | {"patient": code}).json()
        assert [each["id"] for each in page["items"]] == sessions, query
        assert page["total"] == len(sessions)
