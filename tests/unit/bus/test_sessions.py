"""Sessions are told once, and gone only when they stay away."""

from schemas.health import Reason
from schemas.session import Anthropometry, SessionDescription
from schemas.signals import description_key, session_token_key
from services.bus.received import Received
from services.bus.router import open_router
from services.bus.sessions import SessionWatch
from services.bus.settings import BusSettings


def description(session: str) -> SessionDescription:
    body = Anthropometry(
        height_m=None, mass_kg=None, thigh_length_m=0.4, shank_length_m=0.4, hip_width_m=0.2, source="default"
    )
    return SessionDescription(
        session=session, title="", started_unix_ns=0, origin="device", protocol="", estimator="ekf",
        walk_path="turning", hubs=[], anthropometry=body, standing=[], reference=[], duration_s=None,
    )  # fmt: skip


def describe(bus, session: str) -> None:
    answer = Received(description_key("test", session), b"", description(session).model_dump_json().encode())
    bus.serve(answer.key, lambda *_: [answer])


class Watcher:
    def __init__(self, bus, grace_s: float = 0.3) -> None:
        self.came: list[str] = []
        self.went: list[str] = []
        self.watch = SessionWatch(bus, lambda one: self.came.append(one.session), self.went.append, grace_s)


def test_a_session_comes_and_goes(connect, wait_until):
    ingest, watcher = connect(), Watcher(connect())
    describe(ingest, "s")
    token = ingest.declare_token(session_token_key("test", "s"))
    wait_until(lambda: watcher.came == ["s"])
    token.close()
    wait_until(lambda: watcher.went == ["s"])
    ingest.declare_token(session_token_key("test", "s"))
    wait_until(lambda: watcher.came == ["s", "s"])
    watcher.watch.close()


def test_a_token_that_comes_back_was_never_gone(connect, wait_until):
    ingest, watcher = connect(), Watcher(connect(), grace_s=60.0)
    describe(ingest, "s")
    describe(ingest, "other")
    ingest.declare_token(session_token_key("test", "s")).close()
    ingest.declare_token(session_token_key("test", "s"))
    ingest.declare_token(session_token_key("test", "other"))
    wait_until(lambda: "other" in watcher.came)
    wait_until(lambda: "s" in watcher.came)
    assert (sorted(watcher.came), watcher.went) == (["other", "s"], [])
    watcher.watch.close()


def test_a_description_may_come_late_or_broken(connect, wait_until):
    ingest, watcher = connect(), Watcher(connect())
    broken = ingest.serve(description_key("test", "s"), lambda key, *_: [Received(key, b"", b"{}")])
    ingest.declare_token(session_token_key("test", "s"))
    ingest.declare_token(session_token_key("test", "ghost"))
    wait_until(lambda: len(watcher.watch.rejections.report()) == 2)
    report = {item.subject: item.reason for item in watcher.watch.rejections.report()}
    assert report == {"s": Reason.UNDECODABLE, "ghost": Reason.UNKNOWN_SESSION}
    broken.close()
    describe(ingest, "s")
    wait_until(lambda: watcher.came == ["s"])
    watcher.watch.close()


def test_a_refused_description_is_an_unknown_session(connect, wait_until):
    def refuse(*_question):
        raise KeyError("s")

    ingest, watcher = connect(), Watcher(connect())
    ingest.serve(description_key("test", "s"), refuse)
    ingest.declare_token(session_token_key("test", "s"))
    wait_until(watcher.watch.rejections.report)
    assert watcher.watch.rejections.report()[0].reason is Reason.UNKNOWN_SESSION
    watcher.watch.close()


def test_one_bad_callback_does_not_hide_the_next_session(connect, wait_until):
    ingest, bus = connect(), connect()
    came: list[str] = []

    def on_session(one: SessionDescription) -> None:
        came.append(one.session)
        raise RuntimeError("on purpose")

    watch = SessionWatch(bus, on_session, came.append)
    for session in ("a", "b"):
        describe(ingest, session)
        ingest.declare_token(session_token_key("test", session))
    wait_until(lambda: sorted(came) == ["a", "b"])
    wait_until(lambda: bus.errors == 2)
    watch.close()


def test_losing_the_router_is_not_losing_the_sessions(router, connect, wait_until):
    ingest, bus = connect(), connect()
    watcher = Watcher(bus, grace_s=1.5)
    describe(ingest, "s")
    ingest.declare_token(session_token_key("test", "s"))
    wait_until(lambda: watcher.came == ["s"])
    router.close()
    wait_until(lambda: not bus.connected)
    threshold = []
    wait_until(lambda: threshold.append(1) or len(threshold) > 250)
    assert watcher.went == []
    with open_router(BusSettings(router=router.endpoint, site="test")):
        wait_until(lambda: bus.connected)
        threshold.clear()
        wait_until(lambda: threshold.append(1) or len(threshold) > 200)
        assert (watcher.came, watcher.went) == (["s"], [])
        watcher.watch.close()
