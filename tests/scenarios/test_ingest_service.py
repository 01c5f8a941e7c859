"""Ingest on a real bus: what it sends is what a plain loop sends, and no order brings it down."""

import dataclasses
import json
import threading
import time

import pytest

from schemas.health import Progress
from schemas.session import SessionDescription
from schemas.signals import command_key, description_key, progress_key, session_token_key
from services.bus.connection import Bus
from services.bus.loop import EventLoop
from services.bus.router import open_router
from services.bus.settings import BusSettings
from services.cli import live
from services.flow.message import encode_payload
from services.flow.raw_streams import raw_streams
from services.gateway.bus_control import BusControl
from services.gateway.bus_feed import BusLink
from services.gateway.control import StartRequest
from services.ingest.parameters import IngestParameters
from services.ingest.service import IngestService
from services.ingest.source import iter_messages, open_source

pytestmark = pytest.mark.system

SITE = "test"
WALK = "synthetic:walk?duration=6&seed=2"
QUICK = IngestParameters(free_after_s=0.2, linger_s=30.0, farewell_s=0.3, most_ticks=1)
PATIENT = dataclasses.replace(QUICK, free_after_s=600.0)


def wait_until(condition, timeout_s=20.0):
    end = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < end, f"not within {timeout_s} s"
        time.sleep(0.01)


class Stage:
    """A running ingest and somebody who listens."""

    def __init__(self, settings, bus, service):
        self.bus = bus
        self.settings = settings
        self.service = service
        self.received = {}
        self.finals = {}
        self.tokens = {}
        self.loop = EventLoop(bus)
        self.thread = threading.Thread(target=self.loop.run)
        self.thread.start()
        bus.watch_tokens(session_token_key(SITE, "*"), lambda key, alive: self.tokens.update({key: alive}))

    def order(self, command, body):
        data = body if isinstance(body, bytes) else json.dumps(body).encode()
        answers = self.bus.ask(command_key(SITE, "ingest", command), body=data, timeout_s=20.0)
        return json.loads(answers[0].payload)

    def start(self, source=WALK, speed=None, session="s1", **more):
        answer = self.order("start", {"source": source, "speed": speed, "session": session, **more})
        if "error" not in answer:
            for stream in raw_streams(SessionDescription.model_validate(answer)):
                self.loop.post(lambda stream=stream: self.loop.receive(session, stream, None, self._take))
        return answer

    def close(self):
        self.loop.stop()
        self.thread.join(10.0)
        self.loop.close()

    def of(self, session):
        """Messages of a session as a lossless reader gets them: stream, envelope, payload."""
        return list(self.received.get(session, []))

    def ends(self, session):
        return self.finals.get(session, 0)

    def _take(self, message):
        envelope = message.envelope
        self.received.setdefault(message.session, []).append((message.stream.name, envelope, message.payload))
        self.finals[message.session] = self.ends(message.session) + envelope.final


@pytest.fixture
def stage(request):
    with open_router(BusSettings(router="tcp/127.0.0.1:0", site=SITE)) as router:
        settings = BusSettings(router=router.endpoint, site=SITE)
        stop = threading.Event()
        with Bus.open(settings, "ingest") as bus, Bus.open(settings, "listener") as listener:
            service = IngestService(bus, stop, getattr(request, "param", QUICK))
            thread = threading.Thread(target=service.run)
            thread.start()
            stage = Stage(settings, listener, service)
            wait_until(lambda: listener.ask(command_key(SITE, "ingest", "sources"), timeout_s=0.5))
            yield stage
            stage.close()
            stop.set()
            thread.join(20.0)
            assert not thread.is_alive()


def plain(source=WALK):
    return [
        (message.stream.name, message.envelope, encode_payload(message.payload))
        for message in iter_messages(open_source(source, session="s1"))
    ]


@pytest.mark.parametrize("speed", [None, 4.0])
def test_live_is_the_plain_loop(stage, speed):
    description = SessionDescription.model_validate(stage.start(speed=speed))
    assert description.model_copy(update={"started_unix_ns": 0}) == open_source(
        WALK, session="s1"
    ).describe().model_copy(update={"started_unix_ns": 0})
    wait_until(lambda: stage.ends("s1") == 2)
    for stream in ("imu/walker", "reference/reference"):
        assert [m for m in stage.of("s1") if m[0] == stream] == [m for m in plain() if m[0] == stream]


def test_real_time_takes_its_time(stage):
    started = time.monotonic()
    stage.start("synthetic:walk?duration=5", speed=5.0)
    wait_until(lambda: stage.ends("s1") == 2)
    assert time.monotonic() - started >= 0.9


def test_the_token_stays_until_the_session_is_recorded(stage):
    stage.start()
    key = session_token_key(SITE, "s1")
    wait_until(lambda: stage.ends("s1") == 2)
    assert stage.tokens[key]
    answers = stage.bus.ask(description_key(SITE, "s1"))
    assert SessionDescription.model_validate_json(answers[0].payload).session == "s1"
    last = {name: envelope.sequence for name, envelope, _ in stage.of("s1") if envelope.final}
    samples_only = Progress(service="archive", captured_ns=0, positions=last, ended=False)
    stage.bus.put(progress_key(SITE, "s1", "archive"), samples_only.model_dump_json().encode())
    time.sleep(0.5)
    assert stage.tokens[key], "estimates are still missing: a service that crashed must find the session"
    everything = samples_only.model_copy(update={"ended": True})
    stage.bus.put(progress_key(SITE, "s1", "archive"), everything.model_dump_json().encode())
    wait_until(lambda: not stage.tokens[key])
    assert stage.bus.ask(description_key(SITE, "s1"), timeout_s=0.5) == []


@pytest.mark.parametrize("stage", [PATIENT], indirect=True)
def test_a_replay_waits_for_its_slowest_reader(stage):
    stage.start("synthetic:walk?duration=40", speed=None)
    reader = Progress(service="estimation", captured_ns=0, positions={"imu/walker": 50}, ended=False)
    put = stage.bus.put
    for _ in range(20):
        put(progress_key(SITE, "s1", "estimation"), reader.model_dump_json().encode())
        time.sleep(0.05)
    newest = max(envelope.captured_ns for _, envelope, _ in stage.of("s1"))
    assert 5_000_000_000 < newest <= 10_500_000_000

    def followed():
        done = {"imu/walker": sum(name == "imu/walker" for name, _, _ in stage.of("s1")) - 1}
        progress = reader.model_copy(update={"positions": done})
        put(progress_key(SITE, "s1", "estimation"), progress.model_dump_json().encode())
        return stage.ends("s1") == 2

    wait_until(followed)


def test_a_mark_travels_in_the_samples(stage):
    """Once, in the first message after it; the samples are those of a session without it."""
    stage.start("synthetic:walk?duration=30&seed=2", speed=2.0)
    wait_until(lambda: len(stage.of("s1")) > 600)
    from_s, to_s = live.mark_standing(stage.bus, "s1", 2.0)
    assert to_s - from_s == pytest.approx(2.0)
    earlier = stage.order("mark", {"session": "s1", "last_s": 1.0, "at_s": 1.5})
    assert (earlier["from_s"], earlier["to_s"]) == (0.5, 1.5)
    wait_until(lambda: len(stage.of("s1")) > 800)
    stage.order("stop", {"session": "s1"})
    wait_until(lambda: stage.ends("s1") == 2)
    imu = [(envelope, json.loads(body)) for name, envelope, body in stage.of("s1") if name == "imu/walker" and body]
    marked = [(envelope, body["marks"]) for envelope, body in imu if body["marks"]]
    marks = [mark for _, given in marked for mark in given]
    assert [(mark["from_ns"], mark["to_ns"]) for mark in marks[1:]] == [(500_000_000, 1_500_000_000)]
    assert (marks[0]["to_ns"] / 1e9, marks[0]["from_ns"] / 1e9) == (to_s, from_s)
    for envelope, given in marked:
        before = imu[envelope.sequence - 1][0]
        assert all(before.captured_ns <= mark["given_ns"] < envelope.captured_ns for mark in given)
    expected = [json.loads(body)["sensors"] for name, _, body in plain("synthetic:walk?duration=30&seed=2")
                if name == "imu/walker" and body]  # fmt: skip
    assert [body["sensors"] for _, body in imu] == expected[: len(imu)]
    assert "has ended" in stage.order("mark", {"session": "s1"})["error"]
    with pytest.raises(live.NotStarted, match="does not run here"):
        live.mark_standing(stage.bus, "other", 2.0)


def test_stop_closes_the_streams(stage):
    stage.start("synthetic:walk?duration=600", speed=1.0)
    wait_until(lambda: len(stage.of("s1")) > 20)
    assert stage.order("stop", {"session": "s1"}) == {"session": "s1"}
    wait_until(lambda: stage.ends("s1") == 2)
    imu = [envelope for name, envelope, _ in stage.of("s1") if name == "imu/walker"]
    assert [envelope.sequence for envelope in imu] == list(range(len(imu)))
    assert imu[-1].captured_ns == imu[-2].captured_ns


@pytest.mark.parametrize(
    ("command", "body", "word"),
    [
        ("start", b"\xff\x00", "body"),
        ("start", {"speed": 1}, "source"),
        ("start", {"source": "nothing", "speed": 1}, "nothing"),
        ("start", {"source": WALK, "speed": -1}, "speed"),
        ("start", {"source": WALK, "speed": 1, "estimator": "magic"}, "magic"),
        ("start", {"source": WALK, "speed": 1, "session": "a/**"}, "session"),
        ("start", {"source": "synthetic:walk?speed=99", "speed": 1}, "outside"),
        ("start", {"source": "x" * 5000, "speed": 1}, "source"),
        ("start", {"source": "nul\x00byte", "speed": 1}, ""),
        ("stop", {"session": "unknown"}, "does not run"),
        ("stop", b"[]", "body"),
    ],
)
def test_a_bad_order_is_answered_and_forgotten(stage, command, body, word):
    answer = stage.order(command, body)
    assert word in answer["error"]
    assert "session" in stage.start()


def test_a_session_cannot_run_twice(stage):
    stage.start("synthetic:walk?duration=60", speed=1.0)
    assert "runs already" in stage.start(speed=1.0)["error"]


class Lossy:
    """A connection on which the first answers get lost: what was asked for is done, but nobody hears so."""

    def __init__(self, bus, losses):
        self.bus, self.settings, self.losses, self.asked = bus, bus.settings, losses, []

    def ask(self, key, parameters=None, body=b"", timeout_s=2.0):
        answers = self.bus.ask(key, parameters, body, timeout_s)
        assert answers
        self.asked.append(body)
        return answers if len(self.asked) > self.losses else []

    ask_again = Bus.ask_again


def test_a_start_whose_answer_got_lost_is_asked_for_again_and_runs_once(stage):
    """From the command line and from the gateway; the second order is the first one, word by word."""
    walk = "synthetic:walk?duration=600"
    lossy = Lossy(stage.bus, losses=1)
    description = live.start_session(lossy, walk, 1.0, session="s1")
    assert lossy.asked[0] == lossy.asked[1]
    wish = StartRequest("s2", walk, 1.0, *[None] * 6)
    asked = Lossy(stage.bus, losses=2)
    assert BusControl(BusLink(asked)).start(wish).session == "s2"
    assert len(asked.asked) == 3
    wait_until(lambda: len(stage.service._running) == 2)
    described = stage.bus.ask(description_key(SITE, "s1"))
    assert [SessionDescription.model_validate_json(each.payload) for each in described] == [description]


def test_a_quick_session_that_is_over_is_not_played_again(stage):
    first = stage.start()
    wait_until(lambda: stage.ends("s1") == 2)
    last = {name: envelope.sequence for name, envelope, _ in stage.of("s1") if envelope.final}
    done = Progress(service="archive", captured_ns=0, positions=last, ended=True)
    stage.bus.put(progress_key(SITE, "s1", "archive"), done.model_dump_json().encode())
    wait_until(lambda: not stage.service._running)
    assert stage.order("start", {"source": WALK, "speed": None, "session": "s1"}) == first
    assert not stage.service._running
    assert "choose another id" in stage.order("start", {"source": WALK, "speed": 2.0, "session": "s1"})["error"]


def test_an_order_that_never_gets_an_answer_is_given_up(stage):
    lossy = Lossy(stage.bus, losses=99)
    with pytest.raises(live.NotStarted, match="ambula up"):
        live.start_session(lossy, "synthetic:walk?duration=600", 1.0)
    assert len(lossy.asked) == live.START_TRIES


def test_a_source_that_fails_midway_ends_and_leaves_the_others_alone(stage, monkeypatch):
    stage.start("synthetic:walk?duration=20", speed=4.0, session="good")
    running = open_source(WALK, session="bad")

    class Failing:
        describe, rejections = running.describe, running.rejections

        def messages(self):
            for index, message in enumerate(running.messages()):
                if index == 300:
                    raise ValueError("torn cable")
                yield message

    monkeypatch.setattr("services.ingest.service.open_chosen", lambda *_, **__: Failing())
    stage.start(speed=4.0, session="bad")
    wait_until(lambda: stage.ends("bad") == 2)
    wait_until(lambda: stage.ends("good") == 2)
    imu = [envelope.sequence for name, envelope, _ in stage.of("good") if name == "imu/walker"]
    assert imu == list(range(2001))
