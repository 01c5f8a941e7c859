"""Numbers for Prometheus: complete, and never about a person."""

import re
from datetime import UTC, datetime
from types import SimpleNamespace

import pytest
from prometheus_client.parser import text_string_to_metric_families as parsed
from sqlalchemy.exc import OperationalError

from schemas.health import Reason, Rejection, SessionHealth, StreamCount
from services.gateway.access.keys import add_key
from services.gateway.access.roles import Role
from services.gateway.access.scope import EVERYTHING
from services.gateway.app import create_app
from services.gateway.health.tally import Counted, Tally
from services.gateway.live.hub import LiveHub
from services.gateway.tables import PatientRow
from tests.unit.gateway import people
from tests.unit.gateway.test_health import health

LABELS = {"service", "position", "reason", "clinic", "state", "method", "route", "status", "le"}
MEASURES = {
    "ambula_service_up", "ambula_service_ready", "ambula_service_report_age_seconds", "ambula_service_cpu_seconds",
    "ambula_service_resident_bytes", "ambula_service_queue_messages", "ambula_service_queue_capacity_messages",
    "ambula_service_dropped", "ambula_service_errors", "ambula_service_lost", "ambula_rejected", "ambula_sessions",
    "ambula_live_viewers", "ambula_live_skipped_poses", "ambula_requests", "ambula_request_duration_seconds",
    "ambula_log_in_failures", "ambula_audit_entries", "ambula_disk_free_bytes", "ambula_disk_size_bytes",
    "ambula_database_up",
}  # fmt: skip


def scraped(client):
    """name -> {labels without le: value} of every sample."""
    answer = client.get("/metrics")
    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith("text/plain; version=")
    return {family.name: family.samples for family in parsed(answer.text)}


def value(families, family, name=None, **labels):
    found = [each for each in families[family] if each.labels == labels and each.name == (name or each.name)]
    assert len(found) == 1, (family, labels, families[family])
    return found[0].value


@pytest.mark.parametrize(
    ("role", "status"), [(Role.VIEWER, 403), (Role.THERAPIST, 403), (Role.ADMIN, 200), (Role.SERVICE, 200)]
)
def test_numbers_are_for_whoever_operates(stranger, role, status):
    assert stranger.get("/metrics").status_code == 401
    people.sign_in(stranger, role)
    assert stranger.get("/metrics").status_code == status


def test_prometheus_comes_with_a_key_and_leaves_no_trace_in_the_audit(stranger, gateway):
    now = datetime.now(UTC)
    with gateway.database.transaction(EVERYTHING) as database:
        _, key = add_key(database, "prometheus", Role.SERVICE, "main", None, now, days=1)
    bearer = {"Authorization": f"Bearer {key}"}
    lengths = []
    for _ in range(2):
        text = stranger.get("/metrics", headers=bearer).text
        lengths.append(next(line for line in text.splitlines() if line.startswith("ambula_audit_entries ")))
    assert lengths[0] == lengths[1]
    assert key not in text
    assert stranger.get("/metrics", headers={"Authorization": f"Bearer {key}x"}).status_code == 401


def test_services_as_they_report(client, hub):
    refused = [
        Rejection(subject="shank_left", reason=Reason.NOT_FINITE, count=3),
        Rejection(subject="imu/hub", reason=Reason.LATE, count=2),
    ]
    inputs = [StreamCount(stream="imu/hub", received=9, recovered=1, duplicated=2, lost=4)]
    session = SessionHealth(session="a", captured_ns=5, inputs=inputs, rejections=refused)
    hub.health.record(health("estimation", sessions=[session], queue_dropped=7))
    hub.health.record(health("segmentation", readiness="compiling"))
    told = scraped(client)
    assert told.keys() >= MEASURES
    assert value(told, "ambula_service_up", service="estimation") == 1
    assert value(told, "ambula_service_up", service="archive") == 0
    assert value(told, "ambula_service_up", service="segmentation") == 1
    assert value(told, "ambula_service_ready", service="segmentation") == 0
    assert value(told, "ambula_service_resident_bytes", service="estimation") == 1000
    assert value(told, "ambula_service_dropped", service="estimation") == 7
    assert value(told, "ambula_service_lost", service="estimation") == 4
    assert value(told, "ambula_service_cpu_seconds", service="estimation") == 1.0
    assert value(told, "ambula_rejected", service="estimation", position="shank_left", reason="not_finite") == 3
    assert value(told, "ambula_rejected", service="estimation", position="", reason="late") == 2
    assert value(told, "ambula_disk_free_bytes") > 0


def test_requests_are_counted_by_template_and_log_in_failures_apart(client):
    for session in ("a", "b"):
        client.get(f"/v1/sessions/{session}")
    client.post("/v1/sign-in", json={"login": "nobody", "password": "wrong-password-1"})
    client.get("/no/such/page")
    client.request("BREW", "/v1/health")
    told = scraped(client)
    of_sessions = {"method": "GET", "route": "/v1/sessions/{session}"}
    assert value(told, "ambula_requests", "ambula_requests_total", **of_sessions, status="404") == 2
    durations = told["ambula_request_duration_seconds"]
    counted = [each.value for each in durations if each.name.endswith("_count") and each.labels == of_sessions]
    assert counted == [2]
    assert value(told, "ambula_requests", "ambula_requests_total", method="GET", route="other", status="404") == 1
    assert {each.labels["method"] for each in told["ambula_requests"]} == {"GET", "POST", "other"}
    assert value(told, "ambula_log_in_failures", "ambula_log_in_failures_total") == 1


def test_sessions_viewers_and_audit(client, hub, gateway):
    client.post("/v1/sessions", json={"source": "some_walk", "speed": 1.0})
    before = value(scraped(client), "ambula_audit_entries")
    client.post("/v1/patients", json={})
    with client.websocket_connect("/v1/live"):
        told = scraped(client)
        assert value(told, "ambula_live_viewers", clinic="main") == 1
    assert value(told, "ambula_sessions", clinic="main", state="live") == 1
    assert value(told, "ambula_audit_entries") > before
    assert value(told, "ambula_database_up") == 1


def test_a_database_that_is_away_leaves_the_rest(client, gateway, monkeypatch):
    site = next(each for each in gateway.numbers._collector_to_names if type(each).__name__ == "SiteNumbers")

    def away(_scope):
        raise OperationalError("select 1", {}, Exception("gone"))

    monkeypatch.setattr(site, "_database", SimpleNamespace(transaction=away))
    told = scraped(client)
    assert value(told, "ambula_database_up") == 0
    assert value(told, "ambula_service_up", service="archive") == 0
    assert not told["ambula_sessions"]


def test_no_label_is_about_a_person(client, hub, gateway, made):
    """Every route that the API has is asked for a real patient and session while that session runs and is watched."""
    patient = client.post("/v1/patients", json={"year_of_birth": 1957}).json()["code"]
    wish = {"source": "some_walk", "speed": 1.0, "patient": patient}
    session = client.post("/v1/sessions", json=wish).json()["id"]
    hub.open(made.describe(session, title="Synthetic walk"))
    hub.assign(session, patient, "main")
    rejection = Rejection(subject=f"imu/{session}", reason=Reason.LATE, count=1)
    hub.health.record(
        health(
            "ingest", rejections=[rejection],
            sessions=[SessionHealth(session=session, captured_ns=5, inputs=[], rejections=[rejection])],
        )
    )  # fmt: skip
    api = client.get("/v1/openapi.json").json()
    with client.websocket_connect(f"/v1/live/{session}"):
        for path, operations in api["paths"].items():
            if "get" in operations and path != "/metrics":
                named = path.replace("{code}", patient).replace("{session}", session)
                client.get(re.sub(r"{\w+}", "x", named))
        told = scraped(client)
    login = client.get("/v1/me").json()
    samples = [sample for samples in told.values() for sample in samples]
    routes = set(api["paths"]) | {"other"}
    for sample in samples:
        assert set(sample.labels) <= LABELS, sample
        assert sample.labels.get("route", "other") in routes, sample
        for text in (patient, session, login["account"], login["login"]):
            assert not any(text in each for each in sample.labels.values()), sample
    with gateway.database.transaction(EVERYTHING) as database:
        assert database.get(PatientRow, patient) is not None


def test_sums_only_grow_though_sessions_and_instances_go():
    tally = Tally()
    late = Rejection(subject="x", reason=Reason.LATE, count=5)
    tally.take(health("ingest", sessions=[SessionHealth(session="a", captured_ns=0, inputs=[], rejections=[late])]))
    tally.take(health("ingest"))
    again = SessionHealth(session="b", captured_ns=0, inputs=[], rejections=[late.model_copy(update={"count": 2})])
    tally.take(health("ingest", sessions=[again]))
    tally.take(health("ingest", sessions=[again]))
    assert tally.sums()[Counted("ingest", "", "late")] == 7
    tally.take(health("ingest", "2", errors=3))
    tally.take(health("ingest", "2", errors=1))
    tally.forget("ingest", "2")
    assert tally.sums()[Counted("ingest", "", "errors")] == 4


def test_two_gateways_do_not_mix(client, settings, control, tmp_path):
    elsewhere = settings.model_copy(update={"database": f"sqlite:///{tmp_path}/other.sqlite"})
    other = create_app(elsewhere, LiveHub(), control)
    try:
        assert other.state.gateway.numbers is not client.app.state.gateway.numbers
    finally:
        other.state.gateway.database.close()
