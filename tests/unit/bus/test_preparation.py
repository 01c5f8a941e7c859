"""Before a service works: it says so, can be told to stop, and does not swallow what went wrong."""

import threading

import pytest

from schemas.health import Health, Readiness
from schemas.signals import health_key, service_token_key
from services.bus.preparation import prepare


def test_health_says_so_and_nobody_waits_for_it_meanwhile(connect, wait_until):
    bus, listener, done = connect("estimation"), connect(), []
    reports: list[Health] = []
    tokens: list[str] = []
    listener.subscribe(
        health_key("test", "estimation", bus.instance),
        lambda received: reports.append(Health.model_validate_json(received.payload)),
    )
    listener.watch_tokens(service_token_key("test", "*", "*"), lambda key, alive: tokens.append(key))
    steps = (lambda: wait_until(lambda: len(reports) >= 1), lambda: done.append(1))
    assert prepare(bus, steps, threading.Event())
    assert done
    assert {report.readiness for report in reports} == {Readiness.COMPILING}
    assert tokens == []


def test_it_can_be_stopped_on_the_way(connect):
    stop, go = threading.Event(), threading.Event()
    threading.Timer(0.1, stop.set).start()
    assert not prepare(connect(), [lambda: go.wait(20.0)], stop)
    go.set()


def test_what_goes_wrong_is_raised(connect):
    def fail() -> None:
        raise ValueError("cannot be compiled")

    with pytest.raises(ValueError, match="cannot be compiled"):
        prepare(connect(), [fail], threading.Event())
