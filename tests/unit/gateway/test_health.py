from schemas.health import Health, Reason, Rejection, SessionHealth, StreamCount
from services.gateway.health.board import FORGET_S, SERVICES, HealthBoard


def health(service: str, instance: str = "1", **changes) -> Health:
    fields = {
        "service": service, "instance": instance, "uptime_s": 5.0, "cpu_s": 1.0, "rss_bytes": 1000, "queue_length": 0,
        "queue_capacity": 10, "queue_dropped": 0, "errors": 0, "rejections": [], "sessions": [],
        "readiness": "ready",
    }  # fmt: skip
    return Health(**(fields | changes))


def test_every_service_is_reported_with_what_it_refused(client, hub):
    refused = Rejection(subject="imu_pelvis", reason=Reason.NOT_FINITE, count=3)
    count = StreamCount(stream="imu/hub", received=9, recovered=1, duplicated=2, lost=0)
    session = SessionHealth(session="a", captured_ns=5, inputs=[count], rejections=[refused])
    hub.health.record(health("estimation", sessions=[session]))
    told = client.get("/v1/health").json()
    assert (told["connected"], told["database"], told["pages"]) == (True, True, True)
    assert told["silent"] == [name for name in SERVICES if name != "estimation"]
    [service] = told["services"]
    assert (service["service"], service["stale"]) == ("estimation", False)
    assert service["sessions"][0]["rejections"] == [{"subject": "imu_pelvis", "reason": "not_finite", "count": 3}]


def test_without_a_bus_health_still_answers(client):
    told = client.get("/v1/health").json()
    assert (told["connected"], told["silent"], told["services"]) == (False, list(SERVICES), [])


def test_a_database_that_is_away_is_told(client, gateway, monkeypatch):
    monkeypatch.setattr(gateway.database, "answers", lambda: False)
    assert client.get("/v1/health").json()["database"] is False


def test_who_compiles_is_not_silent_and_not_at_work(client, hub):
    hub.health.record(health("estimation", readiness="compiling"))
    told = client.get("/v1/health").json()
    assert told["preparing"] == ["estimation"]
    assert "estimation" not in told["silent"]
    assert told["services"][0]["readiness"] == "compiling"
    hub.health.record(health("estimation", "2"))
    assert client.get("/v1/health").json()["preparing"] == [], "another instance is at work"


def test_silence_is_noticed_and_retired_instances_are_forgotten():
    now = [0.0]
    board = HealthBoard(stale_s=3.0, clock=lambda: now[0])
    board.record(health("estimation", "old"))
    now[0] = 3.1
    assert "estimation" in board.silent()
    board.record(health("estimation", "new"))
    assert "estimation" not in board.silent()
    assert [(report.instance, board.is_stale(age)) for report, age in board.reports()] == [
        ("new", False),
        ("old", True),
    ]
    now[0] = FORGET_S + 1
    assert [report.instance for report, _ in board.reports()] == ["new"]
