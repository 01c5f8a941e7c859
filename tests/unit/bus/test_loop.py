"""The loop: order, timers, errors, the side thread."""

import threading
import time

import pytest

from services.bus.loop import EventLoop


@pytest.fixture
def loop(connect):
    loop = EventLoop(connect())
    yield loop
    loop.close()


def test_actions_come_in_order_and_stop_ends_the_run(loop):
    seen: list[int] = []
    for number in range(5):
        loop.post(lambda number=number: seen.append(number))
    loop.post(loop.stop)
    loop.run()
    assert seen == list(range(5))


def test_an_event_given_from_outside_ends_the_run(connect):
    stop = threading.Event()
    loop = EventLoop(connect(), stop=stop)
    loop.later(0.05, stop.set)
    loop.run()
    loop.close()


def test_timers_repeat_until_closed(loop):
    ticks: list[float] = []
    handle = loop.every(0.02, lambda: ticks.append(time.monotonic()))
    loop.later(0.15, handle.close)
    loop.later(0.3, loop.stop)
    loop.run()
    count = len(ticks)
    assert 1 <= count <= 8
    loop.run_for(0.1, lambda: False)
    assert len(ticks) == count


def test_a_late_timer_is_not_made_up_for(loop):
    ticks: list[int] = []
    loop.every(0.01, lambda: ticks.append(1))
    loop.post(lambda: time.sleep(0.2))
    loop.later(0.0, loop.stop)
    loop.run()
    assert len(ticks) <= 2


def test_errors_are_counted_and_the_loop_goes_on(loop, caplog):
    loop.post(lambda: 1 // 0)
    loop.every(0.01, lambda: {}.pop(1))
    loop.later(0.1, loop.stop)
    loop.run()
    assert loop.errors >= 2
    assert "ZeroDivisionError" in caplog.text


def test_slow_work_is_done_aside_and_its_result_handed_over(loop):
    threads: list[str] = []
    results: list[int] = []

    def work() -> int:
        threads.append(threading.current_thread().name)
        return 42

    loop.background(lambda: 1 // 0, results.append)
    loop.background(work, lambda result: (results.append(result), loop.stop()))
    loop.run()
    assert (results, loop.errors) == ([42], 1)
    assert threads == ["side"]


def test_run_for_ends_when_its_condition_holds(loop):
    done: list[int] = []
    loop.later(0.05, lambda: done.append(1))
    begun = time.monotonic()
    loop.run_for(5.0, lambda: bool(done))
    assert time.monotonic() - begun < 4.0


def test_live_signals_reach_their_handler_on_the_loop(loop, connect):
    got: list[tuple[bytes, str]] = []
    sender = connect()
    loop.subscribe("live/*", lambda received: got.append((received.payload, threading.current_thread().name)))
    loop.every(0.02, lambda: sender.put("live/a", b"x"))
    loop.run_for(10.0, lambda: bool(got))
    assert got[0] == (b"x", threading.current_thread().name)
