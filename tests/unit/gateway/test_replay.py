"""Replays by REST: what a live page was shown, drawn anew from the recording."""

from http import HTTPStatus

import pytest
from fastapi.testclient import TestClient

from schemas.gait import GaitEvent, Stride
from schemas.metrics import SessionMetrics
from services.faults.faults import SensorOff, SensorStuck
from services.gateway.access.roles import Role
from services.gateway.access.scope import EVERYTHING
from services.gateway.app import create_app
from services.gateway.live.hub import LiveHub
from services.gateway.live.views import pose_view
from services.gateway.replay.models import PoseOut
from services.gateway.sessions import records
from services.gateway.settings import GatewaySettings
from tests.unit.gateway import people
from tests.unit.gateway.conftest import FakeControl
from tests.unit.gateway.recorded_sessions import record_session

WALK = "synthetic:walk?duration=16&seed=3"
OFF, STUCK = SensorOff("shank_left", 11.0, 12.5), SensorStuck("thigh_right", 13.5, 14.5)
SPECS = {
    "walk": (WALK, {"faults": [OFF, STUCK]}),
    "knee": ("synthetic:walk?duration=18&seed=3", {"estimator": "knee_axis"}),
    "squat": ("synthetic:squat?person=2&repetitions=1", {}),
    "fused": ("synthetic:walk?camera=1&duration=9&seed=3", {}),
}
TOLD = ("segments", "angles", "angles_std", "centres", "cadence_per_min")
"""Of a picture, what the recording decides; texts and states of sensors are the estimator's own."""
OF_ANOTHER_TIME = {"fused": {"cadence_per_min"}}
"""Two estimators share one picture: the cadence is of the last picture of either."""


@pytest.fixture(scope="module")
def recordings(tmp_path_factory):
    """One session of each kind, run once."""
    data_dir = tmp_path_factory.mktemp("recordings")
    return {name: record_session(data_dir, name, spec, **options) for name, (spec, options) in SPECS.items()}


@pytest.fixture(scope="module")
def browser(recordings, tmp_path_factory):
    """A browser of an administrator; every session is over."""
    pages = tmp_path_factory.mktemp("pages")
    (pages / "index.html").write_text("<!doctype html><title>Ambula</title>")
    data_dir = recordings["walk"].folder.parent
    settings = GatewaySettings(
        data_dir=data_dir, pages_dir=pages, database=f"sqlite:///{pages}/gateway.sqlite", http_names=["testserver"]
    )
    with TestClient(create_app(settings, LiveHub(), FakeControl())) as browser:
        people.sign_in(browser, Role.ADMIN)
        gateway = browser.app.state.gateway
        for each in recordings.values():
            gateway.keeper.appeared(each.description)
            final = next(p for p in reversed(each.payloads) if isinstance(p, SessionMetrics))
            with gateway.database.transaction(EVERYTHING) as database:
                records.record_metrics(database, each.description.session, final)
        yield browser


def asked(browser, path, **query):
    answer = browser.get(f"/v1/sessions/{path}", params=query)
    assert answer.status_code == HTTPStatus.OK, answer.text
    return answer.json()


@pytest.mark.parametrize("name", SPECS)
def test_a_replay_shows_what_the_live_page_was_shown(browser, recordings, name):
    shown = [pose_view([pose], 0.0) for pose in recordings[name].shown if pose.phase == "estimating"]
    drawn = {}
    for from_s in (0.0, 10.0, 20.0):
        page = asked(browser, f"{name}/poses", from_s=from_s, to_s=from_s + 10.0, rate_hz=100)
        drawn |= {pose["at_s"]: pose for pose in page["poses"]}
    assert len(shown) > 20
    for live in shown:
        replayed = drawn[live["at_s"]]
        told = set(TOLD) - OF_ANOTHER_TIME.get(name, set())
        assert {key: replayed[key] for key in told} == {key: live[key] for key in told}, live["at_s"]
        assert set(replayed) == set(live)
        PoseOut.model_validate(replayed)


def test_pictures_come_at_the_pace_asked_for_and_page_by_page(browser):
    first = asked(browser, "walk/poses", from_s=9.0, to_s=10.0, rate_hz=20)
    times = [pose["at_s"] for pose in first["poses"]]
    assert len(times) == 20
    assert times == sorted(times)
    assert (times[0], first["next_s"]) == (9.0, 10.0)
    second = asked(browser, "walk/poses", from_s=first["next_s"], to_s=11.0, rate_hz=20)
    whole = asked(browser, "walk/poses", from_s=9.0, to_s=11.0, rate_hz=20)
    assert first["poses"] + second["poses"] == whole["poses"]
    last = asked(browser, "walk/poses", from_s=15.0)
    assert last["next_s"] is None
    assert last["end_s"] == pytest.approx(16.0, abs=0.1)
    assert asked(browser, "walk/poses", from_s=500.0)["poses"] == []


def test_before_there_is_an_estimate_a_replay_waits_and_a_camera_shows_what_it_sees(browser, recordings):
    before = asked(browser, "knee/poses", to_s=0.5)["poses"]
    assert {pose["phase"] for pose in before} <= {"waiting", "estimating"}
    first_s = next(p.captured_ns / 1e9 for p in recordings["squat"].shown if p.phase == "estimating")
    drawn = asked(browser, "squat/poses", to_s=max(first_s, 1.0))["poses"]
    assert drawn
    assert all(len(pose["centres"]) == 15 for pose in drawn)


def test_losses_say_which_sensor_was_silent_or_stuck_and_when(browser):
    losses = asked(browser, "walk/events")["losses"]
    assert [(loss["source"], loss["kind"]) for loss in losses] == [("shank_left", "missing"), ("thigh_right", "stuck")]
    for loss, fault in zip(losses, (OFF, STUCK), strict=True):
        assert loss["start_s"] == pytest.approx(fault.from_s, abs=0.03)
        assert loss["end_s"] == pytest.approx(fault.to_s, abs=0.03)
    within = asked(browser, "walk/events", from_s=11.5, to_s=12.0)["losses"]
    assert [(loss["source"], loss["end_s"]) for loss in within] == [("shank_left", None)]
    poses = asked(browser, "walk/poses", from_s=11.0, to_s=13.0, rate_hz=10)["poses"]
    states = {p["at_s"]: {s["sensor"]: s["state"] for s in p["sensors"]} for p in poses}
    assert states[12.0]["shank_left"] == "missing"
    assert states[12.0]["shank_right"] == "ok"
    assert states[12.9]["shank_left"] == "ok"


def test_contacts_are_those_of_the_recording(browser, recordings):
    events = [p for p in recordings["walk"].payloads if isinstance(p, GaitEvent) and 9e9 <= p.captured_ns < 12e9]
    told = asked(browser, "walk/events", from_s=9.0, to_s=12.0)["contacts"]
    assert len(told) > 5
    assert [(c["event"], c["side"], c["at_s"]) for c in told] == [
        (e.kind, e.side, e.captured_ns / 1e9) for e in sorted(events, key=lambda e: e.captured_ns)
    ]


def test_the_table_has_every_stride_with_the_reason_and_comes_in_pages(browser, recordings):
    recorded = [p for p in recordings["walk"].payloads if isinstance(p, Stride)]
    page = asked(browser, "walk/strides")
    assert page["total"] == len(page["items"]) == len(recorded) > 5
    told = {(s["side"], s["index"]): s for s in page["items"]}
    for stride in recorded:
        row = told[stride.side, stride.index]
        assert row["start_s"] == stride.start_ns / 1e9
        assert (row["valid"], row["rejected_because"]) == (stride.valid, stride.rejected_because)
        assert row["step_length_m"] == stride.step_length_m
    two, three = (asked(browser, "walk/strides", offset=o, limit=n)["items"] for o, n in ((0, 2), (2, 3)))
    assert two + three == asked(browser, "walk/strides", limit=5)["items"]


@pytest.mark.parametrize(
    ("query", "what"),
    [
        ({"from_s": 5, "to_s": 5}, "ends before"),
        ({"to_s": 61}, "too long"),
        ({"to_s": 30, "rate_hz": 100}, "1500"),
    ],
)
def test_too_much_is_refused_with_what_to_do(browser, query, what):
    answer = browser.get("/v1/sessions/walk/poses", params=query)
    assert answer.status_code == HTTPStatus.UNPROCESSABLE_ENTITY
    assert what in answer.json()["detail"]
    assert answer.json()["next_step"]


@pytest.mark.parametrize("path", ["poses", "strides", "events"])
def test_without_a_recording_or_while_it_runs_a_replay_says_so(client, gateway, settings, made, path):
    gateway.keeper.appeared(made.describe("a"))
    runs = client.get(f"/v1/sessions/a/{path}")
    assert (runs.status_code, "still runs" in runs.json()["detail"]) == (HTTPStatus.CONFLICT, True)
    with gateway.database.transaction(EVERYTHING) as database:
        records.record_metrics(database, "a", made.metrics_at(9.0, final=True))
    gone = client.get(f"/v1/sessions/a/{path}")
    assert (gone.status_code, "no recording" in gone.json()["detail"]) == (HTTPStatus.NOT_FOUND, True)
    assert client.get(f"/v1/sessions/b/{path}").status_code == HTTPStatus.NOT_FOUND


def test_a_damaged_recording_is_named(browser, recordings):
    path = next(recordings["knee"].folder.glob("derived*"))
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    answer = browser.get("/v1/sessions/knee/strides")
    path.write_bytes(whole)
    assert answer.status_code == HTTPStatus.CONFLICT
    assert "damaged" in answer.json()["detail"]
    assert "backup" in answer.json()["next_step"]
