"""What a service says of itself."""

from schemas.health import Health, Reason, Rejection, SessionHealth
from schemas.signals import health_key, service_token_key
from services.bus.health import HealthReporter, resident_bytes
from services.bus.logs import event
from services.bus.queue import BoundedQueue


def test_a_report_each_second_while_the_token_is_held(connect, wait_until):
    bus, listener = connect("metrics"), connect()
    reports: list[Health] = []
    tokens: list[tuple[str, bool]] = []
    key = health_key("test", "metrics", bus.instance)
    listener.subscribe(key, lambda received: reports.append(Health.model_validate_json(received.payload)))
    listener.watch_tokens(service_token_key("test", "*", "*"), lambda key, alive: tokens.append((key, alive)))
    queue = BoundedQueue(capacity=1)
    for number in range(3):
        queue.offer("s", print, number)
    session = SessionHealth(session="s", captured_ns=5, inputs=[], rejections=[])
    rejection = Rejection(subject="x", reason=Reason.LATE, count=2)
    reporter = HealthReporter(
        bus, queue=queue, sessions=lambda: [session], rejections=lambda: [rejection], errors=lambda: 4
    )
    bus.errors = 3
    wait_until(lambda: len(reports) >= 2)
    report = reports[-1]
    assert (report.service, report.instance, report.errors) == ("metrics", bus.instance, 7)
    assert (report.queue_length, report.queue_capacity, report.queue_dropped) == (1, 1, 2)
    assert (report.sessions, report.rejections) == ([session], [rejection])
    assert report.uptime_s > 0
    assert tokens == [(service_token_key("test", "metrics", bus.instance), True)]
    reporter.close()
    wait_until(lambda: len(tokens) == 2)


def test_a_report_that_fails_is_not_the_last(connect, wait_until, caplog):
    calls: list[int] = []

    def sessions() -> list[SessionHealth]:
        calls.append(1)
        raise RuntimeError("on purpose")

    reporter = HealthReporter(connect(), sessions=sessions)
    wait_until(lambda: len(calls) >= 2)
    reporter.close()
    assert "on purpose" in caplog.text


def test_memory_is_measured():
    assert resident_bytes() > 1_000_000


def test_an_event_is_one_line_of_words():
    assert event("x", a=1, b="two words", c="", d='q"') == 'event=x a=1 b="two words" c="" d="q\\""'
