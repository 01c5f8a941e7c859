"""The runner with a real node service process: start, kill, resume, bad input, stop."""

import signal
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from schemas.gait import GaitEvent
from schemas.health import Health, Progress, Reason
from schemas.signals import (
    GAIT_EVENT,
    LIVE_POSE,
    health_key,
    progress_key,
    service_token_key,
    session_token_key,
    stream_key,
)
from services.bus.connection import Bus
from services.bus.router import choose_endpoint, open_router
from services.bus.settings import BusSettings
from services.flow.host import HostedNode
from services.flow.message import Envelope, Message, Stream, decode_payload, encode_payload
from tests.system.stage import HUB, TICK_NS, Collector, FakeIngest, Keeper, Processes, sample, wait_until
from tests.system.summing_service import TROUBLE_NS, SummingNode

pytestmark = pytest.mark.system

SERVICE = str(Path(__file__).with_name("summing_service.py"))
SUMS = Stream(GAIT_EVENT, "estimation")
Closing = Callable[[Any], Any]


def undisturbed(count: int) -> list[bytes]:
    """The payloads that a node that was never stopped puts out, the end's empty one included."""
    host = HostedNode("estimation", "s", SummingNode())
    messages = [Message(HUB, Envelope(0, n, n * TICK_NS), sample(n)) for n in range(count)]
    messages.append(Message(HUB, Envelope(0, count, count * TICK_NS, final=True), None))
    produced = [out for message in messages for out in host.accept(message)]
    return [encode_payload(out.payload) for out in produced if out.stream == SUMS]


def payloads(collector: Collector) -> list[bytes]:
    return [delivery.payload for delivery in list(collector.deliveries)]


def healths(bus: Bus, site: str = "test") -> list[Health]:
    collected: list[Health] = []
    key = health_key(site, "estimation", "*")
    bus.subscribe(key, lambda received: collected.append(Health.model_validate_json(received.payload)))
    return collected


def test_a_service_killed_twice_puts_out_what_an_undisturbed_one_does(
    settings: BusSettings, processes: Processes, closing: Closing
):
    keeper = closing(Keeper(settings))
    ingest, collector = closing(FakeIngest(settings, "s")), closing(Collector(settings))
    receiver = collector.receive("s", SUMS)
    victim = processes.start(SERVICE)
    for _ in range(2):
        ingest.send(300, rate_hz=250)
        known = len(keeper.history)
        wait_until(lambda known=known: len(keeper.history) > known)  # type: ignore[misc]
        ingest.send(100, rate_hz=250)
        victim.kill()
        victim = processes.start(SERVICE)
    ingest.send(200, rate_hz=400)
    ingest.end()
    wait_until(collector.ended, 15.0)
    assert collector.numbers() == list(range(1002))
    assert payloads(collector) == undisturbed(1000)
    assert receiver.count().lost == 0
    assert receiver.count().duplicated > 0
    assert processes.log().count("event=resumed") == 2


def test_a_killed_service_computes_again_what_a_slow_reader_still_lacks(
    settings: BusSettings, processes: Processes, closing: Closing
):
    keeper, ingest = closing(Keeper(settings)), closing(FakeIngest(settings, "s"))
    keeper.tell_progress("s", {"gait_event/estimation": 99})
    victim = processes.start(SERVICE)
    wait_until(lambda: "session_opened" in processes.log())
    keeper.tell_progress("s", {"gait_event/estimation": 99})
    ingest.send(500, rate_hz=250)
    assert [checkpoint.outputs["gait_event/estimation"].sequence <= 99 for checkpoint in keeper.history] == [
        True
    ] * len(keeper.history)
    victim.kill()
    collector = closing(Collector(settings))
    processes.start(SERVICE)
    receiver = collector.receive("s", SUMS)
    ingest.send(10, rate_hz=250)
    ingest.end()
    wait_until(collector.ended, 15.0)
    assert receiver.count().lost <= 100
    assert payloads(collector) == undisturbed(510)[receiver.count().lost :]


def test_a_service_that_is_told_to_stop_leaves_a_checkpoint_and_goes(
    settings: BusSettings, processes: Processes, closing: Closing
):
    keeper, ingest = closing(Keeper(settings)), closing(FakeIngest(settings, "s"))
    collector = closing(Collector(settings))
    collector.receive("s", SUMS)
    child = processes.start(SERVICE)
    ingest.send(300, rate_hz=400)
    wait_until(lambda: len(collector.deliveries) == 300)
    begun = time.monotonic()
    child.send_signal(signal.SIGTERM)
    assert child.wait(10) == 0
    assert time.monotonic() - begun < 2.0
    wait_until(lambda: keeper.history and keeper.history[-1].inputs[HUB.name].sequence == 299)
    processes.start(SERVICE)
    ingest.send(20, rate_hz=400)
    ingest.end()
    wait_until(collector.ended)
    assert payloads(collector) == undisturbed(320)


def test_without_checkpoint_and_beginning_it_starts_in_the_middle_under_a_larger_epoch(
    settings: BusSettings, processes: Processes, closing: Closing
):
    ingest, collector = closing(FakeIngest(settings, "s")), closing(Collector(settings))
    collector.receive("s", SUMS)
    ingest.send(7000)
    processes.start(SERVICE)
    ingest.end()
    wait_until(collector.ended, 15.0)
    first = collector.deliveries[0]
    assert first.envelope.epoch > time.time_ns() - 60e9
    assert collector.numbers() == list(range(len(collector.deliveries)))
    assert len(collector.deliveries) in (6002, 6003)
    assert "event=started_in_the_middle" in processes.log()


def test_a_checkpoint_that_comes_late_is_waited_for_when_the_beginning_is_gone(
    settings: BusSettings, processes: Processes, closing: Closing
):
    keeper, ingest = closing(Keeper(settings)), closing(FakeIngest(settings, "s"))
    collector = closing(Collector(settings))
    collector.receive("s", SUMS)
    child = processes.start(SERVICE)
    ingest.send(6500, rate_hz=20_000)
    wait_until(lambda: len(collector.deliveries) == 6500, 15.0)
    child.send_signal(signal.SIGTERM)
    assert child.wait(10) == 0
    keeper.answers = False
    processes.start(SERVICE)
    ingest.send(500)
    time.sleep(1.5)
    keeper.answers = True
    ingest.end()
    wait_until(collector.ended, 15.0)
    assert payloads(collector) == undisturbed(7000)


def test_what_cannot_be_read_is_counted_and_passed_over(settings: BusSettings, processes: Processes, closing: Closing):
    ingest, collector = closing(FakeIngest(settings, "s")), closing(Collector(settings))
    collector.receive("s", SUMS)
    reports = healths(collector.bus)
    processes.start(SERVICE)
    ingest.send(2)
    ingest.publisher.send_encoded(Envelope(0, 2, 2 * TICK_NS), b'{"sensors": "none"}')
    ingest.publisher.send_encoded(Envelope(0, 3, 3 * TICK_NS), b"\xff\xfe")
    ingest.send(2)
    wait_until(lambda: len(collector.deliveries) == 4)
    wait_until(lambda: reports and reports[-1].sessions and reports[-1].sessions[0].inputs[0].received == 6)
    (session,) = reports[-1].sessions
    assert [(item.subject, item.reason, item.count) for item in session.rejections] == [
        (HUB.name, Reason.UNDECODABLE, 2)
    ]
    assert reports[-1].errors == 0
    assert reports[-1].rss_bytes > 0
    assert reports[-1].queue_capacity > 0


def test_a_bug_met_in_one_session_does_not_end_the_others(
    settings: BusSettings, processes: Processes, closing: Closing
):
    good, bad = closing(FakeIngest(settings, "good")), closing(FakeIngest(settings, "bad"))
    collector = closing(Collector(settings))
    collector.receive("good", SUMS)
    reports = healths(collector.bus)
    processes.start(SERVICE)
    bad.publisher.send(0, sample(TROUBLE_NS))
    wait_until(lambda: reports and reports[-1].errors == 1)
    good.send(50, rate_hz=1000)
    bad.send(5)
    good.end()
    wait_until(collector.ended)
    assert payloads(collector) == undisturbed(50)
    assert "a bug met on purpose" in processes.log()
    assert processes.log().count("event=error") == 1


def test_a_token_without_a_description_is_counted_until_there_is_one(
    settings: BusSettings, processes: Processes, closing: Closing
):
    bus = closing(Bus.open(settings, "test"))
    reports = healths(bus)
    bus.declare_token(session_token_key("test", "ghost"))
    processes.start(SERVICE)
    wait_until(lambda: reports and reports[-1].rejections)
    assert (reports[-1].rejections[0].subject, reports[-1].rejections[0].reason) == ("ghost", Reason.UNKNOWN_SESSION)
    collector, ingest = closing(Collector(settings)), closing(FakeIngest(settings, "ghost"))
    collector.receive("ghost", SUMS)
    ingest.end()
    wait_until(collector.ended)


def test_it_lingers_until_the_archive_has_the_whole_session(
    settings: BusSettings, processes: Processes, closing: Closing
):
    keeper, ingest = closing(Keeper(settings)), closing(FakeIngest(settings, "s"))
    processes.start(SERVICE)
    ingest.send(20)
    ingest.end()
    wait_until(lambda: "event=session_ended" in processes.log())
    keeper.tell_progress("s", {"gait_event/estimation": 21})
    late = closing(Collector(settings))
    late.receive("s", SUMS)
    wait_until(late.ended)
    assert "event=session_closed" not in processes.log()
    keeper.tell_progress("s", {"gait_event/estimation": 21}, ended=True)
    wait_until(lambda: "event=session_closed" in processes.log())
    wait_until(lambda: keeper.history and keeper.history[-1].outputs["gait_event/estimation"].ended)


def test_progress_and_the_view_are_told(settings: BusSettings, processes: Processes, closing: Closing):
    ingest, bus = closing(FakeIngest(settings, "s")), closing(Bus.open(settings, "test"))
    told: list[Progress] = []
    poses: list[int] = []
    pose = Stream(LIVE_POSE, "estimation")

    def take_pose(received: Any) -> None:
        envelope = Envelope.decode(received.attachment)
        if decode_payload(LIVE_POSE, envelope, received.payload) is not None:
            poses.append(envelope.sequence)

    bus.subscribe(stream_key("test", "s", pose.signal, pose.source), take_pose)
    bus.subscribe(
        progress_key("test", "s", "estimation"),
        lambda received: told.append(Progress.model_validate_json(received.payload)),
    )
    processes.start(SERVICE)
    ingest.send(100, rate_hz=200)
    ingest.end()
    wait_until(lambda: told and told[-1].positions == {HUB.name: 100})
    assert poses == sorted(set(poses))
    assert len(poses) >= 9


def test_it_waits_for_a_router_and_says_so_once(processes: Processes, closing: Closing, tmp_path: Path):
    settings = BusSettings(router=choose_endpoint("tcp/127.0.0.1:0"), site="test")
    late = closing(Processes(settings, tmp_path))
    child = late.start(SERVICE)
    wait_until(lambda: "event=waiting_for_router" in late.log())
    time.sleep(0.5)
    closing(open_router(settings))
    alive: list[str] = []
    watcher = closing(Bus.open(settings, "test"))
    watcher.watch_tokens(service_token_key("test", "estimation", "*"), lambda key, _: alive.append(key))
    wait_until(lambda: alive)
    assert late.log().count("event=waiting_for_router") == 1
    child.send_signal(signal.SIGINT)
    assert child.wait(10) == 0


def test_sums_are_sums():
    event = GaitEvent.model_validate_json(undisturbed(4)[-2])
    assert event.time_std_s == 0 + 1 + 2 + 3
