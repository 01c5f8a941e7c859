"""The live connections over the test client, and the hub and viewer by themselves."""

import asyncio
import json
import time

import pytest
from starlette.websockets import WebSocketDisconnect

from services.gateway.access.scope import EVERYTHING
from services.gateway.live import views
from services.gateway.live.hub import LiveHub, NotLive, TooManyViewers
from services.gateway.live.viewer import TRY_AGAIN, Ended, Viewer
from services.gateway.parameters import GatewayParameters


def read_until(socket, kind: str, most: int = 50) -> dict:
    for _ in range(most):
        message = json.loads(socket.receive_text())
        if message["kind"] == kind:
            return message
    raise AssertionError(f"no {kind} among {most} messages")


def payload(pose) -> bytes:
    return pose.model_dump_json().encode()


def test_a_viewer_gets_the_session_then_skeletons_in_si_units(client, gateway, hub, made):
    gateway.keeper.appeared(made.describe("a"))
    with client.websocket_connect("/v1/live/a") as socket:
        session = json.loads(socket.receive_text())
        assert (session["kind"], session["id"], session["patient"]) == ("session", "a", None)
        assert session["body"] == {"thigh_length_m": 0.42, "shank_length_m": 0.41, "hip_width_m": 0.18}
        pose = made.pose_at(3.25)
        hub.pose("a", payload(pose))
        shown = read_until(socket, "pose")
        assert shown["at_s"] == 3.25
        assert shown["age_s"] < 5
        assert shown["angles"]["knee_flexion_left"] == pytest.approx(pose.angles["knee_flexion_left"], abs=1e-5)
        assert set(shown["segments"]) == {"pelvis", "thigh_left", "shank_left", "thigh_right", "shank_right"}


def test_skeletons_between_two_shown_ones_leave_their_angles(client, gateway, hub, made):
    gateway.keeper.appeared(made.describe("a"))
    times = [1.0, 1.01, 1.02]
    for at_s in times:
        hub.pose("a", payload(made.pose_at(at_s)))
    with client.websocket_connect("/v1/live/a") as socket:
        shown = read_until(socket, "pose")
    assert [each["at_s"] for each in shown["trail"]] + [shown["at_s"]] == times
    assert shown["trail"][0]["angles"]["hip_flexion_left"] != shown["angles"]["hip_flexion_left"]


def test_no_nanoseconds_reach_a_browser(client, gateway, hub, made):
    gateway.keeper.appeared(made.describe("a"))
    with client.websocket_connect("/v1/live/a") as socket:
        hub.pose("a", payload(made.pose_at(4000.0)))
        hub.tell("a", views.event_view(made.contact_at(4000.0, "left")))
        hub.tell("a", views.stride_view(made.stride_at(4000.0, "left", 7)))
        gateway.keeper.measured("a", made.metrics_at(4000.0, final=False))
        for kind in ("gait_event", "stride", "metrics", "pose"):
            text = json.dumps(read_until(socket, kind))
            assert "_ns" not in text
            assert "4000000000000" not in text


def test_events_come_each_and_in_order(client, gateway, hub, made):
    gateway.keeper.appeared(made.describe("a"))
    with client.websocket_connect("/v1/live/a") as socket:
        read_until(socket, "session")
        for index in range(30):
            hub.tell("a", views.stride_view(made.stride_at(2.0 + index, "left", index)))
        assert [read_until(socket, "stride")["index"] for _ in range(30)] == list(range(30))


def test_a_late_viewer_gets_the_last_numbers_at_once(client, gateway, hub, made):
    gateway.keeper.appeared(made.describe("a"))
    hub.tell("a", views.stride_view(made.stride_at(9.0, "right", 4)))
    gateway.keeper.measured("a", made.metrics_at(9.0, final=False))
    with client.websocket_connect("/v1/live/a") as socket:
        assert read_until(socket, "stride")["index"] == 4
        assert read_until(socket, "metrics")["at_s"] == 9.0


def test_the_end_of_a_session_is_told_and_closes_normally(client, gateway, made):
    gateway.keeper.appeared(made.describe("a"))
    with client.websocket_connect("/v1/live/a") as socket:
        gateway.keeper.measured("a", made.metrics_at(60.0, final=True))
        assert read_until(socket, "metrics")["final"] is True
        assert read_until(socket, "ended")["state"] == "finished"
        with pytest.raises(WebSocketDisconnect) as closed:
            read_until(socket, "nothing more")
        assert closed.value.code == 1000


def test_a_session_that_does_not_run_is_closed_with_its_own_code(client):
    with client.websocket_connect("/v1/live/nobody") as socket:
        with pytest.raises(WebSocketDisconnect) as closed:
            socket.receive_text()
        assert closed.value.code == 4404


def test_a_foreign_page_may_not_listen(client, gateway, made):
    gateway.keeper.appeared(made.describe("a"))
    for path in ("/v1/live", "/v1/live/a"):
        with (
            pytest.raises(WebSocketDisconnect),
            client.websocket_connect(path, headers={"origin": "https://elsewhere.example"}) as socket,
        ):
            socket.receive_text()
    with client.websocket_connect("/v1/live/a", headers={"origin": "http://testserver"}) as socket:
        assert read_until(socket, "session")["id"] == "a"


def test_a_link_to_a_patient_shows_at_once(client, gateway, made):
    gateway.keeper.appeared(made.describe("a"))
    code = client.post("/v1/patients", json={}).json()["code"]
    with client.websocket_connect("/v1/live/a") as socket:
        read_until(socket, "session")
        client.patch("/v1/sessions/a", json={"patient": code})
        assert read_until(socket, "patient")["patient"] == code


def test_the_floor_lists_what_runs_with_its_age(client, gateway, hub, made):
    gateway.keeper.appeared(made.describe("a", title="First"))
    gateway.keeper.appeared(made.describe("b", title="Second"))
    hub.pose("a", payload(made.pose_at(12.0, lost="imu_shank_left")))
    with client.websocket_connect("/v1/live") as socket:
        floor = json.loads(socket.receive_text())
    cards = {card["id"]: card for card in floor["sessions"]}
    assert (cards["a"]["title"], cards["a"]["elapsed_s"], cards["a"]["cadence_per_min"]) == ("First", 12.0, 109.0)
    assert cards["a"]["age_s"] < 5
    assert {"sensor": "imu_shank_left", "state": "missing", "since_s": 0.0} in cards["a"]["sensors"]
    assert cards["a"]["sensor_segments"]["imu_shank_left"] == "shank_left"
    assert (cards["b"]["age_s"], cards["b"]["phase"]) == (None, None)
    assert (floor["connected"], len(floor["silent"])) == (False, 5)


def test_garbage_on_the_way_is_counted_and_the_rest_goes_on(client, gateway, hub, made):
    gateway.keeper.appeared(made.describe("a"))
    with client.websocket_connect("/v1/live/a") as socket:
        read_until(socket, "session")
        hub.pose("a", b"\xff{not json")
        deadline = time.monotonic() + 10
        while hub.undecodable == 0 and time.monotonic() < deadline:
            time.sleep(0.01)
        hub.pose("a", payload(made.pose_at(1.0)))
        assert read_until(socket, "pose")["at_s"] == 1.0
    assert hub.undecodable >= 1


def test_poses_of_unknown_sessions_are_not_kept(hub, made):
    hub.pose("nobody", payload(made.pose_at(1.0)))
    assert hub._sessions == {}


def run(coroutine):
    return asyncio.run(asyncio.wait_for(coroutine, 20))


def test_a_slow_viewer_skips_skeletons_and_gets_the_newest():
    async def scene():
        viewer = Viewer(event_queue=4, scope=EVERYTHING)
        for number in range(100):
            viewer.show("pose", str(number))
        assert await viewer.take() == "99"
        assert viewer.skipped == 99

    run(scene())


def test_a_viewer_that_takes_no_events_is_let_go_to_read_again():
    async def scene():
        viewer = Viewer(event_queue=4, scope=EVERYTHING)
        for number in range(5):
            viewer.tell(str(number))
        with pytest.raises(Ended) as ended:
            await viewer.take()
        assert ended.value.code == TRY_AGAIN

    run(scene())


def test_events_go_before_skeletons_and_the_end_comes_last():
    async def scene():
        viewer = Viewer(event_queue=4, scope=EVERYTHING)
        viewer.show("pose", "pose")
        viewer.tell("event")
        viewer.end(1000, "over")
        assert [await viewer.take(), await viewer.take()] == ["event", "pose"]
        with pytest.raises(Ended, match="over"):
            await viewer.take()

    run(scene())


def test_one_viewer_that_never_reads_delays_nobody(made):
    async def scene():
        hub = LiveHub()
        hub.bind(asyncio.get_running_loop())
        hub.open(made.describe("a"))
        await asyncio.sleep(0)
        with hub.watch("a", EVERYTHING) as stuck, hub.watch("a", EVERYTHING) as quick:
            seen = []
            for number in range(20):
                hub.pose("a", payload(made.pose_at(float(number + 1))))
                while True:
                    message = json.loads(await quick.take())
                    if message["kind"] == "pose":
                        seen.append(message["at_s"])
                        break
            assert seen == [float(number + 1) for number in range(20)]
            assert stuck.skipped >= 18
        await hub.stop()

    run(scene())


def test_viewers_are_bounded_and_leave_nothing_behind(made):
    async def scene():
        hub = LiveHub(GatewayParameters(most_viewers=2))
        hub.open(made.describe("a"))
        with pytest.raises(NotLive), hub.watch("b", EVERYTHING):
            pass
        with hub.watch("a", EVERYTHING), hub.watch_floor(EVERYTHING):
            with pytest.raises(TooManyViewers), hub.watch("a", EVERYTHING):
                pass
            with pytest.raises(TooManyViewers), hub.watch_floor(EVERYTHING):
                pass
        live = hub._sessions["a"]
        assert (live.viewers, live.task, hub._floor_viewers, hub._floor_task) == (set(), None, set(), None)

    run(scene())
