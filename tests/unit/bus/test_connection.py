"""Publish, ask, serve, tokens, and what happens when someone misbehaves."""

import threading

import pytest

from services.bus.connection import Bus, BusUnavailable, RemoteError
from services.bus.received import Handle, Received
from services.bus.router import choose_endpoint
from services.bus.settings import BusSettings


def test_without_a_router_the_error_says_what_to_do():
    settings = BusSettings(router=choose_endpoint("tcp/127.0.0.1:0"))
    with pytest.raises(BusUnavailable, match=r"ambula up.*AMBULA_ROUTER"):
        Bus.open(settings, "test", timeout_s=0.2)


def test_waiting_for_a_router_can_be_given_up():
    stop = threading.Event()
    stop.set()
    assert Bus.open_when_ready(BusSettings(router=choose_endpoint("tcp/127.0.0.1:0")), "test", stop) is None


def test_a_put_arrives_with_its_attachment(connect, wait_until):
    sender, receiver = connect(), connect()
    got: list[Received] = []
    receiver.subscribe("ambula/test/s/imu/*", got.append)
    wait_until(lambda: sender.put("ambula/test/s/imu/hub", b"body", b"beside") or got)
    assert got[0] == Received("ambula/test/s/imu/hub", b"beside", b"body")
    sender.put("ambula/test/s/imu/hub", b"bare")
    wait_until(lambda: got[-1].payload == b"bare")
    assert got[-1].attachment == b""


def test_a_closed_subscription_is_silent(connect, wait_until):
    sender, receiver = connect(), connect()
    got, still = [], []
    handle = receiver.subscribe("a/b", got.append)
    receiver.subscribe("a/b", still.append)
    wait_until(lambda: sender.put("a/b", b"") or (got and still))
    handle.close()
    handle.close()
    before = len(got), len(still)
    wait_until(lambda: sender.put("a/b", b"") or len(still) > before[1] + 3)
    assert len(got) == before[0]


def test_every_server_answers_and_each_answer_is_kept(connect, wait_until):
    bus, servers = connect(), [connect(), connect()]
    for number, server in enumerate(servers):
        server.serve("q/*", lambda key, _p, _b, n=number: [Received(key, b"%d" % n, b"%d" % i) for i in range(3)])
    # A server that was declared just now may not be known yet.
    wait_until(lambda: len({a.attachment for a in bus.ask("q/1")}) == len(servers))
    answers = bus.ask("q/1")
    assert sorted((a.attachment, a.payload) for a in answers) == [
        (b"%d" % n, b"%d" % i) for n in range(2) for i in range(3)
    ]


def test_a_question_carries_parameters_and_body(connect, wait_until):
    bus, server = connect(), connect()
    asked = []
    server.serve("q", lambda *question: asked.append(question) or [])
    wait_until(lambda: bus.ask("q", {"from": "3", "to": "-1"}, b"body") or asked)
    assert asked == [("q", {"from": "3", "to": "-1"}, b"body")]


def test_nobody_answers_for_nobody(connect):
    assert connect().ask("nobody/here") == []


def test_what_a_server_raises_is_the_answer(connect, wait_until):
    bus, server = connect(), connect()

    def refuse(*_question):
        raise ValueError("no such recording")

    server.serve("q", refuse)
    with pytest.raises(RemoteError, match="ValueError: no such recording"):
        wait_until(lambda: bus.ask("q"))
    assert server.errors == 1


def test_later_answers_end_with_done(connect, wait_until):
    bus, server = connect(), connect()
    server.serve("q", lambda key, _p, _b: [Received(key, b"", b"%d" % i) for i in range(20)])
    wait_until(lambda: bus.ask("q"))
    news: list[object] = []
    bus.ask_later("q", {}, news.append, lambda: news.append("done"))
    bus.ask_later("nobody", {}, news.append, lambda: news.append("nobody"))
    wait_until(lambda: "done" in news and "nobody" in news)
    answers = [one.payload for one in news if isinstance(one, Received)]
    assert answers == [b"%d" % i for i in range(20)]
    assert [one for one in news if one != "nobody"][-1] == "done"


def test_a_callback_that_raises_is_counted_and_called_again(connect, wait_until):
    sender, receiver = connect(), connect()
    receiver.subscribe("a/b", lambda _: 1 // 0)
    wait_until(lambda: sender.put("a/b", b"") or receiver.errors >= 2)


def test_tokens_are_seen_come_and_go(connect, wait_until):
    holder, watcher = connect(), connect()
    seen: list[tuple[str, bool]] = []
    holder.declare_token("t/early")
    watcher.watch_tokens("t/*", lambda key, alive: seen.append((key, alive)))
    wait_until(lambda: seen == [("t/early", True)])
    handle = holder.declare_token("t/late")
    wait_until(lambda: seen[1:] == [("t/late", True)])
    handle.close()
    wait_until(lambda: seen[2:] == [("t/late", False)])
    holder.close()
    wait_until(lambda: seen[3:] == [("t/early", False)])


def test_a_bus_knows_whether_it_has_a_router(router, connect, wait_until):
    bus = connect()
    assert bus.connected
    router.close()
    wait_until(lambda: not bus.connected)


def test_closing_twice_is_once(connect):
    with connect() as bus:
        pass
    bus.close()


def test_a_handle_closes_once():
    calls: list[int] = []
    handle = Handle(lambda: calls.append(1))
    assert not handle.closed
    handle.close()
    handle.close()
    assert (handle.closed, calls) == (True, [1])


def test_settings_come_from_the_environment(monkeypatch):
    monkeypatch.setenv("AMBULA_ROUTER", "tcp/router:7447")
    monkeypatch.setenv("AMBULA_SITE", "clinic")
    assert BusSettings() == BusSettings(router="tcp/router:7447", site="clinic")
