"""The node service in this process: sessions that vanish, ends that nobody comes for, descriptions it cannot serve."""

import threading
from functools import partial

import pytest

from schemas.checkpoint import Checkpoint, StreamPosition
from schemas.session import SessionDescription
from schemas.signals import GAIT_EVENT
from services.bus import hosting, runner
from services.bus.connection import Bus
from services.bus.runner import NodeService
from services.bus.sessions import SessionWatch
from services.bus.settings import BusSettings
from services.flow.message import Stream
from services.flow.node import Node
from tests.system.stage import Collector, FakeIngest, Keeper
from tests.system.summing_service import build

SUMS = Stream(GAIT_EVENT, "estimation")


@pytest.fixture
def settings(router):
    return BusSettings(router=router.endpoint, site="test")


@pytest.fixture
def serve(connect, monkeypatch):
    """Starts a node service on a thread; sessions count as gone after 0.3 s."""
    monkeypatch.setattr(runner, "SessionWatch", partial(SessionWatch, grace_s=0.3))
    stop = threading.Event()
    threads: list[threading.Thread] = []

    def start(factory=build) -> Bus:
        bus = connect("estimation")
        threads.append(threading.Thread(target=NodeService(bus, factory, stop).run, daemon=True))
        threads[-1].start()
        return bus

    yield start
    stop.set()
    for thread in threads:
        thread.join(5.0)
        assert not thread.is_alive()


@pytest.fixture
def collector(settings):
    collector = Collector(settings)
    yield collector
    collector.close()


def test_a_session_whose_producer_died_is_frozen_and_goes_on_when_it_returns(
    settings, serve, collector, wait_until, caplog
):
    caplog.set_level("INFO")
    keeper = Keeper(settings)
    collector.receive("s", SUMS)
    serve()
    ingest = FakeIngest(settings, "s")
    ingest.send(20)
    wait_until(lambda: len(collector.deliveries) == 20)
    ingest.token.close()
    wait_until(lambda: "event=session_closed" in caplog.text)
    assert "event=session_gone session=s" in caplog.text
    wait_until(lambda: keeper.history and keeper.history[-1].inputs["imu/hub"].sequence == 19)
    ingest.token = ingest.bus.declare_token(f"ambula/test/@session/{ingest.session}")
    ingest.send(5)
    ingest.end()
    wait_until(collector.ended)
    assert collector.numbers() == list(range(27))
    assert "event=resumed session=s" in caplog.text
    ingest.close()
    keeper.close()


def test_an_end_that_nobody_archives_is_kept_for_a_while_only(
    settings, serve, collector, wait_until, caplog, monkeypatch
):
    monkeypatch.setattr(hosting, "LINGER_S", 0.5)
    caplog.set_level("INFO")
    collector.receive("s", SUMS)
    serve()
    ingest = FakeIngest(settings, "s")
    ingest.send(3)
    ingest.end()
    wait_until(collector.ended)
    wait_until(lambda: "event=session_closed" in caplog.text)
    ingest.close()


def test_a_description_that_cannot_be_served_is_an_error_and_no_more(settings, serve, collector, wait_until, caplog):
    def picky(description: SessionDescription) -> Node:
        if description.session == "bad":
            raise ValueError("no such estimator")
        return build(description)

    collector.receive("good", SUMS)
    serve(picky)
    ingests = [FakeIngest(settings, session) for session in ("bad", "good")]
    for ingest in ingests:
        ingest.send(3)
        ingest.end()
    wait_until(collector.ended)
    wait_until(lambda: "no such estimator" in caplog.text)
    assert collector.numbers() == list(range(5))
    for ingest in ingests:
        ingest.close()


@pytest.mark.parametrize("kept", [b"not JSON", b"{}"])
def test_a_checkpoint_that_cannot_be_read_is_started_over(settings, serve, collector, wait_until, caplog, kept):
    keeper = Keeper(settings)
    keeper.kept["ambula/test/@checkpoint/s/estimation"] = kept
    collector.receive("s", SUMS)
    ingest = FakeIngest(settings, "s")
    ingest.send(3)
    ingest.end()
    serve()
    wait_until(collector.ended)
    assert collector.numbers() == list(range(5))
    assert "event=checkpoint_unreadable" in caplog.text
    ingest.close()
    keeper.close()


def test_a_checkpoint_that_does_not_fit_the_node_is_started_over(settings, serve, collector, wait_until, caplog):
    keeper = Keeper(settings)
    place = StreamPosition(epoch=0, sequence=1, ended=False)
    foreign = Checkpoint(
        service="estimation", session="s", captured_ns=1, inputs={"imu/hub": place}, outputs={}, state={"other": 1}
    )
    keeper.kept["ambula/test/@checkpoint/s/estimation"] = foreign.model_dump_json().encode()
    collector.receive("s", SUMS)
    ingest = FakeIngest(settings, "s")
    ingest.send(3)
    ingest.end()
    serve()
    wait_until(collector.ended)
    assert collector.numbers() == list(range(5))
    assert "event=checkpoint_refused" in caplog.text
    ingest.close()
    keeper.close()
