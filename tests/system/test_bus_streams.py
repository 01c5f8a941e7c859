"""Lossless streams between real processes: disorder, loss, kills, freezes, late comers, a new router."""

import signal
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from schemas.health import Reason
from schemas.signals import stream_key
from services.bus.connection import Bus, Received
from services.bus.queue import BoundedQueue
from services.bus.router import open_router
from services.bus.settings import BusSettings
from services.flow.message import Envelope
from services.flow.position import Position
from tests.system.stage import HUB, Collector, FakeIngest, Processes, sample, wait_until

pytestmark = pytest.mark.system

PRODUCER = str(Path(__file__).with_name("producing_process.py"))
CONSUMER = str(Path(__file__).with_name("consuming_process.py"))
Closing = Callable[[Any], Any]


def lines(path: Path) -> list[tuple[int, ...]]:
    text = path.read_text() if path.exists() else ""
    complete = text[: text.rfind("\n") + 1]
    return [tuple(int(word) for word in line.split()) for line in complete.splitlines()]


def numbers(path: Path) -> list[int]:
    return [line[0] for line in lines(path)]


def test_disorder_doubles_and_losses_leave_no_trace(settings: BusSettings, processes: Processes, closing: Closing):
    collector = closing(Collector(settings))
    receiver = collector.receive("s", HUB)
    processes.start(PRODUCER, "s", "2000", "1000", "unruly")
    wait_until(lambda: len(collector.deliveries) == 2000, 15.0)
    assert collector.numbers() == list(range(2000))
    count = receiver.count()
    assert (count.received, count.lost) == (2000, 0)
    assert count.recovered >= 100
    assert count.duplicated >= 400


def test_a_consumer_that_was_killed_gets_everything_the_next_time(
    processes: Processes, closing: Closing, tmp_path: Path
):
    first, second = tmp_path / "first", tmp_path / "second"
    victim = processes.start(CONSUMER, "s", str(first))
    processes.start(PRODUCER, "s", "1000", "500")
    wait_until(lambda: len(lines(first)) > 200)
    victim.kill()
    processes.start(CONSUMER, "s", str(second))
    wait_until(lambda: len(lines(second)) == 1001, 15.0)
    assert numbers(second) == list(range(1001))
    assert [line[1] for line in lines(second)] == [*range(1000), -1]
    assert numbers(first) == list(range(len(lines(first))))


@pytest.mark.parametrize("frozen", ["producer", "consumer"])
def test_a_freeze_beyond_the_lease_loses_nothing(processes: Processes, tmp_path: Path, frozen: str):
    out = tmp_path / "out"
    children = {
        "consumer": processes.start(CONSUMER, "s", str(out)),
        "producer": processes.start(PRODUCER, "s", "1000", "300"),
    }
    wait_until(lambda: len(lines(out)) > 100)
    children[frozen].send_signal(signal.SIGSTOP)
    time.sleep(2.5)
    children[frozen].send_signal(signal.SIGCONT)
    wait_until(lambda: len(lines(out)) == 1001, 15.0)
    assert numbers(out) == list(range(1001))


def test_a_late_subscriber_gets_all_that_the_ring_has(settings: BusSettings, closing: Closing):
    ingest = closing(FakeIngest(settings, "s"))
    ingest.send(3000)
    collector = closing(Collector(settings))
    receiver = collector.receive("s", HUB)
    ingest.send(200, rate_hz=1000)
    ingest.end()
    wait_until(collector.ended)
    assert collector.numbers() == list(range(3201))
    assert receiver.count().lost == 0


def test_a_subscriber_goes_on_behind_its_position(settings: BusSettings, closing: Closing):
    ingest = closing(FakeIngest(settings, "s"))
    ingest.send(100)
    collector = closing(Collector(settings))
    collector.receive("s", HUB, Position(0, 89, ended=False))
    wait_until(lambda: len(collector.deliveries) == 10)
    assert collector.numbers() == list(range(90, 100))


def test_what_the_ring_has_forgotten_is_counted_lost(settings: BusSettings, closing: Closing):
    ingest = closing(FakeIngest(settings, "s"))
    ingest.send(7000)
    collector = closing(Collector(settings))
    receiver = collector.receive("s", HUB)
    ingest.end()
    wait_until(collector.ended)
    assert collector.numbers()[0] == receiver.count().lost == 999
    assert receiver.count().received == 6002
    (hole,) = receiver.take_given_up()
    assert (hole.first, hole.last) == (0, 998)
    assert receiver.take_given_up() == []


def test_a_new_router_finds_everything_as_it_was(closing: Closing):
    router = open_router(BusSettings(router="tcp/127.0.0.1:0", site="test"))
    settings = BusSettings(router=router.endpoint, site="test")
    ingest, collector = closing(FakeIngest(settings, "s")), closing(Collector(settings))
    receiver = collector.receive("s", HUB)
    alive: list[bool] = []
    collector.bus.watch_tokens("ambula/test/@session/*", lambda _, is_alive: alive.append(is_alive))
    sender = threading.Thread(target=ingest.send, args=(1200, 300.0))
    sender.start()
    wait_until(lambda: len(collector.deliveries) > 100)
    router.close()
    wait_until(lambda: alive == [True, False])
    time.sleep(0.5)
    closing(open_router(settings))
    sender.join()
    ingest.end()
    wait_until(collector.ended)
    assert collector.numbers() == list(range(1201))
    # How many messages fall into the outage is the machine's affair; that some did makes this a test.
    assert receiver.count().recovered > 10
    assert alive == [True, False, True]


def test_a_queue_that_overflows_is_counted_and_repaired(settings: BusSettings, closing: Closing):
    ingest, collector = closing(FakeIngest(settings, "s")), closing(Collector(settings))
    collector.loop.queue.capacity = 50
    receiver = collector.receive("s", HUB)
    wait_until(lambda: receiver.position is None and len(collector.loop.queue) == 0)
    release = threading.Event()
    collector.loop.post(release.wait)
    ingest.send(500, rate_hz=2000)
    release.set()
    ingest.end()
    wait_until(collector.ended)
    assert collector.numbers() == list(range(501))
    assert collector.loop.queue.dropped["s/imu/hub"] > 100


def test_a_message_without_an_envelope_is_counted_and_skipped(settings: BusSettings, closing: Closing):
    ingest, collector = closing(FakeIngest(settings, "s")), closing(Collector(settings))
    receiver = collector.receive("s", HUB)
    ingest.send(3)
    wait_until(lambda: len(collector.deliveries) == 3)
    key = stream_key("test", "s", HUB.signal, HUB.source)
    for attachment in (b"", b"nonsense", b"0 -1 0 0 v"):
        ingest.bus.put(key, b"{}", attachment)
    ingest.send(3)
    wait_until(lambda: len(collector.deliveries) == 6)
    assert collector.numbers() == list(range(6))
    assert [(item.reason, item.count) for item in receiver.rejections.report()] == [(Reason.UNDECODABLE, 3)]


def test_a_handler_that_raises_does_not_end_the_loop(settings: BusSettings, closing: Closing):
    ingest, collector = closing(FakeIngest(settings, "s")), closing(Collector(settings))
    collector.loop.post(lambda: 1 // 0)
    collector.receive("s", HUB)
    ingest.send(3)
    wait_until(lambda: len(collector.deliveries) == 3)
    assert collector.loop.errors == 1


def test_the_last_message_is_found_though_nothing_follows_it(settings: BusSettings, closing: Closing):
    ingest, collector = closing(FakeIngest(settings, "s")), closing(Collector(settings))
    receiver = collector.receive("s", HUB)
    ingest.send(5)
    wait_until(lambda: len(collector.deliveries) == 5)
    offer, collector.loop.queue.offer = collector.loop.queue.offer, lambda *_: False  # type: ignore[method-assign]
    ingest.send(1)
    time.sleep(0.2)
    collector.loop.queue.offer = offer  # type: ignore[method-assign]
    wait_until(lambda: len(collector.deliveries) == 6)
    assert receiver.count().recovered == 1


def test_two_streams_of_one_signal_stay_apart(settings: BusSettings, closing: Closing):
    ingests = [closing(FakeIngest(settings, session)) for session in ("a", "b")]
    collectors = [closing(Collector(settings)) for _ in ingests]
    for collector, session in zip(collectors, ("a", "b"), strict=True):
        collector.receive(session, HUB)
    for number in range(50):
        for ingest in ingests[: 1 + number % 2]:
            ingest.send(1)
    wait_until(lambda: len(collectors[0].deliveries) == 50 and len(collectors[1].deliveries) == 25)
    assert {delivery.session for delivery in collectors[1].deliveries} == {"b"}


def test_the_queue_knows_its_bound():
    queue = BoundedQueue(capacity=2)
    assert [queue.offer("s", print, number) for number in range(4)] == [True, True, False, False]
    queue.post(print, "control")
    assert (len(queue), queue.dropped_total, queue.dropped["s"]) == (3, 2, 2)
    taken = [queue.take(0.0) for _ in range(3)]
    assert [task.argument for task in taken if task is not None] == [0, 1, "control"]
    assert queue.take(0.01) is None


def test_a_sample_travels_unchanged(settings: BusSettings, closing: Closing):
    ingest, collector = closing(FakeIngest(settings, "s")), closing(Collector(settings))
    collector.receive("s", HUB)
    sent = ingest.publisher.send(17, sample(4))
    wait_until(lambda: collector.deliveries)
    (delivery,) = collector.deliveries
    assert delivery.envelope == sent == Envelope(0, 0, 17)
    assert delivery.payload == sample(4).model_dump_json().encode()


def test_an_answer_that_comes_too_late_is_none_and_is_asked_for_again(settings: BusSettings, closing: Closing) -> None:
    asked = threading.Semaphore(0)
    go_on = threading.Event()

    def slow(key: str, _parameters: dict[str, str], _body: bytes) -> list[Received]:
        asked.release()
        go_on.wait(30.0)
        return [Received(key, b"", b"done")]

    peer, bus = closing(Bus.open(settings, "peer")), closing(Bus.open(settings, "bus"))
    peer.serve("ambula/test/slow", slow)
    # Before the router has told of the peer there is no answer either, and nobody was asked.
    end = time.monotonic() + 30.0
    while not asked.acquire(blocking=False):
        assert time.monotonic() < end
        assert bus.ask("ambula/test/slow", timeout_s=0.3) == []
    go_on.set()
    assert [each.payload for each in bus.ask_again("ambula/test/slow", b"", 0.3, tries=100)] == [b"done"]
