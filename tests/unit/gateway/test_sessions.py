from http import HTTPStatus

import pytest

from services.gateway.control import ControlRefused, ControlUnavailable

SOURCE = "synthetic:walk?speed=1.1&seed=3&duration=60"


def start(client, **more):
    return client.post("/v1/sessions", json={"source": SOURCE, **more})


def test_starting_asks_the_ingest_and_lists_the_session_as_live(client, control):
    answer = start(client, speed=2.0, estimator="ekf")
    assert answer.status_code == HTTPStatus.CREATED
    session = answer.json()
    request = control.started[0]
    assert (request.session, request.source, request.speed, request.estimator) == (session["id"], SOURCE, 2.0, "ekf")
    assert (session["state"], session["title"], session["patient"]) == ("live", "Synthetic walk", None)
    assert client.get(f"/v1/sessions/{session['id']}").json() == session


def test_speed_null_means_as_fast_as_possible_and_absent_means_real_time(client, control):
    start(client, speed=None)
    start(client)
    assert [request.speed for request in control.started] == [None, 1.0]


def test_the_path_of_the_walk_is_the_operator_s_choice_and_else_the_source_s(client, control):
    start(client, walk_path="straight", estimator="joukov_published")
    start(client)
    assert [request.walk_path for request in control.started] == ["straight", None]
    assert control.started[0].estimator == "joukov_published"
    assert start(client, walk_path="circle").status_code == HTTPStatus.UNPROCESSABLE_ENTITY


def test_a_session_can_be_started_for_a_patient(client):
    code = client.post("/v1/patients", json={}).json()["code"]
    session = start(client, patient=code).json()
    assert session["patient"] == code
    assert client.get(f"/v1/patients/{code}").json()["sessions"] == 1


def test_a_session_for_an_unknown_patient_is_not_started(client, control):
    assert start(client, patient="NOBODY").status_code == HTTPStatus.NOT_FOUND
    assert control.started == []
    assert client.get("/v1/sessions").json()["total"] == 0


@pytest.mark.parametrize(
    ("trouble", "status", "step"),
    [
        (ControlUnavailable("No ingest service answers."), HTTPStatus.SERVICE_UNAVAILABLE, "ambula up"),
        (ControlRefused("no such recording"), HTTPStatus.UNPROCESSABLE_ENTITY, "GET /v1/sources"),
    ],
)
def test_a_session_that_could_not_start_says_why_and_stays_listed(client, control, trouble, status, step):
    control.trouble = trouble
    answer = start(client)
    assert answer.status_code == status
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["detail"] == str(trouble)
    assert step in answer.json()["next_step"]
    [session] = client.get("/v1/sessions").json()["items"]
    assert (session["state"], session["reason"]) == ("failed", str(trouble))


@pytest.mark.parametrize(
    "body",
    [
        {},
        {"source": "/etc/passwd"},
        {"source": "../../secrets.mcap"},
        {"source": "https://example.org/walk"},
        {"source": SOURCE, "speed": 0},
        {"source": SOURCE, "speed": -1},
        {"source": SOURCE, "estimator": "magic"},
        {"source": SOURCE, "state": "finished"},
        {"source": SOURCE, "patient": "no code"},
    ],
)
def test_what_is_not_a_wish_to_start_is_refused(client, control, body):
    answer = client.post("/v1/sessions", json=body)
    assert answer.status_code == HTTPStatus.UNPROCESSABLE_ENTITY
    assert answer.json()["faults"]
    assert control.started == []


def test_a_form_or_plain_text_from_a_foreign_page_starts_nothing(client, control):
    for kind in ("text/plain", "application/x-www-form-urlencoded"):
        answer = client.post("/v1/sessions", content=b'{"source": "some_walk"}', headers={"content-type": kind})
        assert answer.status_code == HTTPStatus.UNPROCESSABLE_ENTITY
    assert control.started == []


def test_lists_can_be_filtered_by_state_and_patient(client, gateway, made):
    code = client.post("/v1/patients", json={}).json()["code"]
    mine, other = start(client, patient=code).json()["id"], start(client).json()["id"]
    gateway.keeper.appeared(made.describe(other))
    gateway.keeper.measured(other, made.metrics_at(60.0, final=True))

    def ids(**query):
        return [session["id"] for session in client.get("/v1/sessions", params=query).json()["items"]]

    assert sorted(ids()) == sorted([mine, other])
    assert ids(patient=code) == [mine]
    assert ids(state="finished") == [other]
    assert ids(state="finished", patient=code) == []
    assert client.get("/v1/sessions", params={"state": "odd"}).status_code == HTTPStatus.UNPROCESSABLE_ENTITY


def test_a_session_that_is_linked_later_has_the_patient_s_paretic_side_where_it_said_none(client):
    code = client.post("/v1/patients", json={"paretic_side": "left"}).json()["code"]
    started = start(client).json()
    assert started["conditions"]["paretic_side"] is None
    path = f"/v1/sessions/{started['id']}"
    assert client.patch(path, json={"patient": code}).json()["conditions"]["paretic_side"] == "left"
    assert client.get(path).json()["conditions"]["paretic_side"] == "left"
    client.patch(f"/v1/patients/{code}", json={"paretic_side": "right"})
    assert client.get(path).json()["conditions"]["paretic_side"] == "right"
    assert client.patch(path, json={"patient": None}).json()["conditions"]["paretic_side"] is None


def test_a_session_can_be_linked_and_unlinked(client):
    code = client.post("/v1/patients", json={}).json()["code"]
    path = f"/v1/sessions/{start(client).json()['id']}"
    assert client.patch(path, json={"patient": code}).json()["patient"] == code
    assert client.patch(path, json={"patient": None}).json()["patient"] is None
    assert client.patch(path, json={"patient": "NOBODY"}).status_code == HTTPStatus.NOT_FOUND
    assert client.patch(path, json={"patient": code, "title": "x"}).status_code == HTTPStatus.UNPROCESSABLE_ENTITY
    assert client.patch(path, json={}).status_code == HTTPStatus.UNPROCESSABLE_ENTITY


def test_stopping_reaches_the_ingest_and_an_ended_session_cannot_be_stopped(client, control, gateway, made):
    session = start(client).json()["id"]
    assert client.post(f"/v1/sessions/{session}/stop").status_code == HTTPStatus.ACCEPTED
    assert control.stopped == [session]
    gateway.keeper.measured(session, made.metrics_at(12.0, final=True))
    answer = client.post(f"/v1/sessions/{session}/stop")
    assert answer.status_code == HTTPStatus.CONFLICT
    assert "finished" in answer.json()["detail"]


@pytest.mark.parametrize(
    ("trouble", "status"),
    [(ControlUnavailable("gone"), HTTPStatus.SERVICE_UNAVAILABLE), (ControlRefused("not mine"), HTTPStatus.CONFLICT)],
)
def test_a_stop_that_fails_says_so(client, control, trouble, status):
    session = start(client).json()["id"]
    control.trouble = trouble
    assert client.post(f"/v1/sessions/{session}/stop").status_code == status


def test_a_mark_reaches_the_ingest_with_the_time_on_the_screen(client, control):
    session = client.post("/v1/sessions", json={"source": "synthetic:walk"}).json()["id"]
    answer = client.post(f"/v1/sessions/{session}/marks", json={"last_s": 5.0, "at_s": 14.4})
    assert answer.status_code == HTTPStatus.ACCEPTED
    assert answer.json() == {"session": session, "from_s": 9.4, "to_s": 14.4}
    client.post(f"/v1/sessions/{session}/marks", json={})
    assert control.marked == [(session, 5.0, 14.4), (session, 3.0, None)]


@pytest.mark.parametrize("body", [{"last_s": 0.5}, {"last_s": 11}, {"at_s": -1}, {"last_s": "x"}, {"kind": "sitting"}])
def test_what_is_no_mark_is_refused(client, control, body):
    session = client.post("/v1/sessions", json={"source": "synthetic:walk"}).json()["id"]
    answer = client.post(f"/v1/sessions/{session}/marks", json=body)
    assert answer.status_code == HTTPStatus.UNPROCESSABLE_ENTITY
    assert control.marked == []


def test_a_session_that_does_not_run_cannot_be_marked(client, control, gateway, made):
    assert client.post("/v1/sessions/0000000000000000/marks", json={}).status_code == HTTPStatus.NOT_FOUND
    gateway.keeper.appeared(made.describe("feed"))
    answer = client.post("/v1/sessions/feed/marks", json={})
    assert answer.status_code == HTTPStatus.CONFLICT
    assert "does not run here" in answer.json()["detail"]


def test_metrics_and_curves_come_back_as_they_were_measured(client, gateway, made):
    session = start(client).json()["id"]
    for part in ("metrics", "curves"):
        assert client.get(f"/v1/sessions/{session}/{part}").status_code == HTTPStatus.NOT_FOUND
    gateway.keeper.measured(session, made.metrics_at(20.0, final=False))
    assert client.get(f"/v1/sessions/{session}/metrics").json()["final"] is False
    gateway.keeper.measured(session, made.metrics_at(60.0, final=True))
    numbers, curves = (client.get(f"/v1/sessions/{session}/{part}").json() for part in ("metrics", "curves"))
    sent = made.metrics_at(60.0, final=True)
    assert (numbers["final"], numbers["at_s"]) == (True, 60.0)
    assert numbers["metrics"] == [metric.model_dump(mode="json") for metric in sent.metrics]
    assert curves["curves"] == [curve.model_dump(mode="json") for curve in sent.curves]


def test_a_finished_session_has_its_length_and_highlights(client, gateway, made):
    session = start(client).json()["id"]
    gateway.keeper.measured(session, made.metrics_at(58.5, final=True))
    told = client.get(f"/v1/sessions/{session}").json()
    assert (told["state"], told["duration_s"]) == ("finished", 58.5)
    assert told["highlights"] == {"walking_speed": 1.08, "cadence_per_min": 109.1, "strides": 24}


@pytest.mark.parametrize(
    "part", ["", "/metrics", "/curves", "/phases", "/repetitions", "/recordings", "/recordings/raw.mcap"]
)
def test_an_unknown_session_is_not_found(client, part):
    answer = client.get(f"/v1/sessions/nobody{part}")
    assert answer.status_code == HTTPStatus.NOT_FOUND
    assert answer.json()["next_step"]


def test_a_session_id_that_is_none_is_refused(client):
    assert client.get("/v1/sessions/%2e%2e").status_code in (HTTPStatus.NOT_FOUND, HTTPStatus.UNPROCESSABLE_ENTITY)
    assert client.get("/v1/sessions/a%20b").status_code == HTTPStatus.UNPROCESSABLE_ENTITY


def test_sources_offer_recordings_and_walkers_and_the_default_estimator_first(client, control):
    offer = client.get("/v1/sources").json()
    assert offer["ready"] is True
    assert {source["kind"] for source in offer["sources"]} == {"recording", "synthetic", "device"}
    assert offer["estimators"][0]["default"] is True
    assert [estimator["default"] for estimator in offer["estimators"]].count(True) == 1
    for source in offer["sources"]:
        assert client.post("/v1/sessions", json={"source": source["id"]}).status_code == HTTPStatus.CREATED


def test_sources_are_offered_even_when_no_ingest_answers(client, control):
    control.trouble = ControlUnavailable("gone")
    offer = client.get("/v1/sources").json()
    assert offer["ready"] is False
    assert {source["kind"] for source in offer["sources"]} == {"synthetic"}
