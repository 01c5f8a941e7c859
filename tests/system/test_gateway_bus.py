"""The gateway's side of the bus: what it hears, what it asks, and that it outlives the router."""

import json
import time

import pytest

from schemas.signals import GAIT_EVENT, LIVE_POSE, METRICS, STRIDE, command_key, description_key, session_token_key
from services.bus.connection import Bus
from services.bus.health import HealthReporter
from services.bus.publisher import LivePublisher, StreamPublisher
from services.bus.received import Received
from services.bus.router import open_router
from services.flow.message import Envelope, Message, Stream
from services.gateway.access.scope import EVERYTHING
from services.gateway.bus_control import BusControl
from services.gateway.bus_feed import BusFeed, BusLink
from services.gateway.control import ControlRefused, ControlUnavailable, StartRequest
from services.gateway.database import open_database
from services.gateway.live.hub import LiveHub
from services.gateway.sessions import records
from services.gateway.sessions.keeper import SessionKeeper
from tests.unit.gateway.walk import contact_at, describe, metrics_at, pose_at, stride_at

pytestmark = pytest.mark.system

ORDER = StartRequest("a", "synthetic:walk", 1.0, None, None, None, None, None, None)


class Listening:
    """A feed with everything behind it."""

    def __init__(self, settings, folder) -> None:
        self.hub, self.link = LiveHub(), BusLink()
        self.database = open_database(f"sqlite:///{folder}/gateway.sqlite")
        self.keeper = SessionKeeper(self.database, self.hub)
        self.feed = BusFeed(settings, self.link, self.hub, self.keeper)
        self.feed.start()

    def close(self) -> None:
        self.feed.stop()
        self.database.close()

    def row(self, session: str):
        with self.database.transaction(EVERYTHING) as database:
            return database.get(records.SessionRow, session)


def wait(condition, what: str):
    deadline = time.monotonic() + 30
    while not condition():
        assert time.monotonic() < deadline, what
        time.sleep(0.02)


def answers(control) -> bool:
    try:
        return bool(control.offered())
    except ControlUnavailable:
        return False


def announce(bus, closing, session="a"):
    description = describe(session, title="Started by itself").model_dump_json().encode()
    key = description_key(bus.settings.site, session)
    closing(bus.serve(key, lambda *_: [Received(key, b"", description)]))
    return closing(bus.declare_token(session_token_key(bus.settings.site, session)))


def test_a_session_that_starts_by_itself_is_seen_measured_and_finished(settings, closing, tmp_path):
    listening = closing(Listening(settings, tmp_path))
    bus = closing(Bus.open(settings, "ingest"))
    announce(bus, closing)
    wait(lambda: listening.row("a") is not None and listening.row("a").state == "live", "the session is listed")
    assert (listening.row("a").patient_code, listening.row("a").title) == (None, "Started by itself")

    live = LivePublisher(bus, "a", Stream(LIVE_POSE, "estimation"))
    live.forward(Message(live.stream, Envelope(0, 0, 5_000_000_000), pose_at(5.0)))
    wait(lambda: bool(listening.hub._sessions["a"].poses), "the skeleton has come")

    metrics = closing(StreamPublisher(bus, "a", Stream(METRICS, "metrics")))
    metrics.send(5_000_000_000, metrics_at(5.0, final=False))
    wait(lambda: listening.row("a").metrics is not None, "the numbers have come")
    metrics.send(9_000_000_000, metrics_at(9.0, final=True))
    metrics.end(9_000_000_000)
    wait(lambda: listening.row("a").state == "finished", "the session has finished")
    assert not listening.hub.is_live("a")


def test_a_gateway_that_comes_late_catches_up_from_the_rings(settings, closing, tmp_path):
    bus = closing(Bus.open(settings, "segmentation"))
    announce(bus, closing)
    strides = closing(StreamPublisher(bus, "a", Stream(STRIDE, "segmentation")))
    contacts = closing(StreamPublisher(bus, "a", Stream(GAIT_EVENT, "segmentation")))
    metrics = closing(StreamPublisher(bus, "a", Stream(METRICS, "metrics")))
    for index in range(5):
        contacts.send(index, contact_at(1.0 + index, "left"))
        strides.send(index, stride_at(2.0 + index, "left", index))
    metrics.send(7_000_000_000, metrics_at(7.0, final=False))

    listening = closing(Listening(settings, tmp_path))
    wait(lambda: listening.hub.is_live("a"), "the session is seen")
    memory = listening.hub._sessions["a"].memory
    wait(lambda: [each["index"] for each in memory.of("stride")] == [4], "the last stride is known")
    wait(lambda: [each["at_s"] for each in memory.of("metrics")] == [7.0], "the numbers are known")


def test_health_is_heard_and_its_end_too(settings, closing, tmp_path):
    listening = closing(Listening(settings, tmp_path))
    reporter = HealthReporter(closing(Bus.open(settings, "estimation")))
    board = listening.hub.health
    wait(lambda: "estimation" not in board.silent(), "estimation is heard")
    assert board.brief()["connected"] is True
    reporter.close()
    wait(lambda: "estimation" in board.silent(), "its silence is noticed")
    wait(lambda: any(health.service == "gateway" for health, _ in board.reports()), "the gateway hears itself")


def test_orders_reach_the_ingest_and_refusals_come_back(settings, closing, tmp_path):
    listening = closing(Listening(settings, tmp_path))
    control = BusControl(listening.link)
    wait(lambda: listening.link.bus is not None, "connected")
    with pytest.raises(ControlUnavailable, match="No ingest"):
        control.start(ORDER)

    bus = closing(Bus.open(settings, "ingest"))
    orders = []

    def serve(command, answer):
        key = command_key(bus.settings.site, "ingest", command)

        def handle(_key, _parameters, body):
            orders.append((command, json.loads(body)))
            return [Received(key, b"", json.dumps(answer).encode())]

        closing(bus.serve(key, handle))

    serve("start", describe("a").model_dump(mode="json"))
    serve("mark", {"session": "a", "from_s": 9.5, "to_s": 12.5})
    serve("stop", {"error": "session b does not run here"})
    known = {"name": "some_squats", "title": "Some squats", "hubs": False, "cameras": True, "task": "squat"}
    camera = {"name": "device:kinect?port=7788", "title": "Kinect on port 7788", "sending": True}
    recordings = [{"name": "some_walk", "title": "Some walk", "duration_s": None}, known]
    serve("sources", {"recordings": recordings, "devices": [camera]})
    wait(lambda: answers(control), "the ingest answers")
    assert [(each.id, each.kind, each.worn, each.task) for each in control.offered()] == [
        ("device:kinect?port=7788", "device", "camera", None),
        ("some_walk", "recording", None, None),
        ("some_squats", "recording", "camera", "squat"),
    ]
    assert control.start(ORDER) == describe("a")
    with pytest.raises(ControlRefused, match="does not run here"):
        control.stop("b")
    assert control.mark("a", 3.0, 12.5) == (9.5, 12.5)
    start, mark = dict(orders)["start"], dict(orders)["mark"]
    chosen = dict.fromkeys(("estimator", "walk_path", "known_rhythms", "task", "walkway_m", "conditions"))
    assert start == {"session": "a", "source": "synthetic:walk", "speed": 1.0} | chosen
    assert mark == {"session": "a", "last_s": 3.0, "at_s": 12.5}


def test_before_there_is_a_router_orders_say_so(tmp_path):
    with pytest.raises(ControlUnavailable, match="router"):
        BusControl(BusLink()).offered()


def test_the_feed_waits_for_the_router_and_outlives_it(router, settings, closing, tmp_path):
    router.close()
    listening = closing(Listening(settings, tmp_path))
    time.sleep(0.5)
    assert listening.link.bus is None
    first = open_router(settings)
    bus = closing(Bus.open(settings, "ingest"))
    announce(bus, closing)
    wait(lambda: listening.hub.is_live("a"), "the session is seen through the late router")
    first.close()
    time.sleep(1.0)
    assert listening.row("a").state == "live"
    closing(open_router(settings))
    metrics = closing(StreamPublisher(bus, "a", Stream(METRICS, "metrics")))
    metrics.send(9_000_000_000, metrics_at(9.0, final=True))
    wait(lambda: listening.row("a").state == "finished", "the numbers come through the next router")
