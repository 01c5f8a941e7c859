"""What one asker may cost the others (OWASP API 4): how often, how much, how slowly, how many at once."""

import asyncio
import contextlib
import json
import socket
import threading
import time
from http import HTTPStatus

import pytest
import uvicorn
from fastapi.testclient import TestClient
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from services.gateway.access.roles import Role
from services.gateway.access.scope import Scope
from services.gateway.app import create_app
from services.gateway.connections import BoundedHttp
from services.gateway.limits import MOST_REMEMBERED, Buckets
from services.gateway.live.hub import LiveHub, TooManyViewers
from services.gateway.openapi_file import FILE
from services.gateway.parameters import GatewayParameters
from services.gateway.report import printing
from services.gateway.serve import config_of
from tests.unit.gateway import people

PATIENCE_S = 30
CALM = 40


class Clock:
    now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


def test_a_bucket_gives_its_burst_and_then_its_rate():
    clock = Clock()
    buckets = Buckets(per_s=2.0, burst=3.0, clock=clock)
    assert [buckets.wait_s("a") for _ in range(4)] == [0.0, 0.0, 0.0, 0.5]
    assert buckets.wait_s("b") == 0.0
    clock.now_s = 0.5
    assert [buckets.wait_s("a"), buckets.wait_s("a")] == [0.0, 0.5]
    clock.now_s = 1e6
    assert [buckets.wait_s("a") for _ in range(4)][-1] == 0.5


def test_askers_without_number_cost_no_memory_without_bound():
    buckets = Buckets(per_s=1.0, burst=1.0, clock=Clock())
    for number in range(3 * MOST_REMEMBERED):
        buckets.wait_s(number)
    assert len(buckets._buckets) == MOST_REMEMBERED


@pytest.fixture
def limited(settings, control):
    """A gateway whose bounds are soon reached, and no token comes back."""
    parameters = GatewayParameters(
        requests_per_caller_per_s=1e-6, request_burst_of_caller=5, requests_per_address_per_s=1e-6,
        request_burst_of_address=12, sign_ins_per_address_per_s=1e-6, sign_in_burst_of_address=2,
    )  # fmt: skip
    with TestClient(create_app(settings, LiveHub(parameters), control)) as client:
        yield client


def test_one_sign_in_is_refused_before_its_address_is(limited):
    people.sign_in(limited, Role.VIEWER)
    answers = [limited.get("/v1/me") for _ in range(6)]
    assert [answer.status_code for answer in answers] == [200] * 5 + [429]
    told = answers[-1]
    assert told.headers["content-type"] == "application/problem+json"
    assert int(told.headers["retry-after"]) > 0
    assert told.headers["content-security-policy"]
    limited.cookies.clear()
    assert [limited.get("/").status_code for _ in range(7)] == [200] * 6 + [429]


def test_claims_to_be_somebody_else_do_not_help(limited):
    statuses = [limited.get("/v1/me", headers={"cookie": f"ambula={n}.x"}).status_code for n in range(13)]
    assert statuses == [401] * 12 + [429]


def test_passwords_are_tried_less_often_than_pages_are_read(limited):
    body = {"login": "nobody", "password": "guess"}
    assert [limited.post("/v1/sign-in", json=body).status_code for _ in range(3)] == [401, 401, 429]
    assert limited.get("/v1/sign-in").status_code == HTTPStatus.OK


def test_no_page_limit_is_above_a_hundred():
    described = json.loads(FILE.read_text())
    limits = [
        (path, each["schema"])
        for path, methods in described["paths"].items()
        for operation in methods.values()
        for each in operation.get("parameters", ())
        if each["name"] == "limit"
    ]
    assert len(limits) >= 5
    rows_of_one_session = {"/v1/sessions/{session}/strides"}
    assert {path for path, schema in limits if not schema.get("maximum", 1e9) <= 100} == rows_of_one_session


def test_one_clinic_does_not_take_every_live_connection():
    hub = LiveHub(GatewayParameters(most_viewers_of_clinic=2, most_viewers=3))
    one, other = Scope("one"), Scope("other")

    async def scene() -> None:
        hub.bind(asyncio.get_running_loop())
        with hub.watch_floor(one), hub.watch_floor(one):
            with pytest.raises(TooManyViewers), hub.watch_floor(one):
                pass
            with hub.watch_floor(other), pytest.raises(TooManyViewers), hub.watch_floor(other):
                pass
        with hub.watch_floor(one):
            pass
        await hub.stop()

    asyncio.run(scene())


def test_the_third_report_at_once_is_told_to_wait(monkeypatch):
    entered, leave = threading.Semaphore(0), threading.Event()

    class Press:
        def pdf(self, report):
            entered.release()
            assert leave.wait(PATIENCE_S)
            return b"%PDF"

    monkeypatch.setattr(printing, "press", Press)
    threads = [threading.Thread(target=printing.printed, args=(None,)) for _ in range(printing.MOST_AT_ONCE)]
    for thread in threads:
        thread.start()
        assert entered.acquire(timeout=PATIENCE_S)
    with pytest.raises(printing.Busy) as busy:
        printing.printed(None)
    assert (busy.value.status, busy.value.retry_after_s) == (HTTPStatus.SERVICE_UNAVAILABLE, 2)
    leave.set()
    for thread in threads:
        thread.join(PATIENCE_S)
    assert printing.printed(None) == b"%PDF"


def test_a_problem_says_when_to_come_again(client, gateway, monkeypatch):
    monkeypatch.setattr(gateway.live.health, "reports", lambda: (_ for _ in ()).throw(printing.Busy()))
    assert client.get("/v1/health").headers["retry-after"] == "2"


class Served:
    """The gateway behind the server that it has in operation, on a free port."""

    def __init__(self, app, settings, parameters, headers_within_s: float) -> None:
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        config = config_of(app, settings, parameters)
        config.http_protocol_class = type("Hurried", (BoundedHttp,), {"headers_within_s": headers_within_s})
        config.http = config.http_protocol_class
        self.server = uvicorn.Server(config)
        self.thread = threading.Thread(target=lambda: asyncio.run(self.server.serve(sockets=[self.listener])))

    def __enter__(self):
        self.thread.start()
        deadline = time.monotonic() + PATIENCE_S
        while not self.server.started:
            assert time.monotonic() < deadline
            time.sleep(0.01)
        return self

    def __exit__(self, *_) -> None:
        self.server.should_exit = True
        self.thread.join(PATIENCE_S)
        self.listener.close()

    def connect(self) -> socket.socket:
        return socket.create_connection(("127.0.0.1", self.port), timeout=PATIENCE_S)


@pytest.fixture
def served(settings, control):
    settings.http_names = ["*"]
    parameters = GatewayParameters(
        body_within_s=0.3, requests_per_caller_per_s=1e-6, request_burst_of_caller=CALM
    )  # fmt: skip
    app = create_app(settings, LiveHub(parameters), control)
    with Served(app, settings, parameters, headers_within_s=0.3) as server:
        server.cookie = people.cookie(app, Role.VIEWER)
        yield server


@pytest.mark.parametrize(
    "begun",
    [b"", b"GET /v1/sign-in HTTP/1.1\r\nHost: 127.0.0.1\r\nX-", b"GET /v1/live HTTP/1.1\r\nUpgrade: websocket\r\n"],
    ids=["nothing", "half a request", "half a handshake"],
)
def test_headers_that_do_not_come_end_the_connection(served, begun):
    with contextlib.closing(served.connect()) as raw:
        raw.sendall(begun)
        assert ended(raw)
    # The same on a connection that has had its answer.
    with contextlib.closing(served.connect()) as raw:
        raw.sendall(b"GET /v1/sign-in HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        assert raw.recv(65_536).startswith(b"HTTP/1.1 200")
        raw.sendall(b"GET /v1/sign-in HTTP/1.1\r\nHo")
        assert ended(raw)


def ended(raw: socket.socket) -> bool:
    """Whether the other side ends the connection; waits for it."""
    try:
        while raw.recv(65_536):
            pass
    except ConnectionResetError:
        pass
    return True


def test_headers_without_end_are_not_kept(served):
    with contextlib.closing(served.connect()) as raw:
        raw.sendall(b"GET /v1/sign-in HTTP/1.1\r\n")
        with contextlib.suppress(ConnectionError):
            for number in range(64):
                raw.sendall(f"X-{number}: {'x' * 1024}\r\n".encode())
        assert ended(raw)


def test_a_body_that_does_not_come_to_an_end_is_refused(served):
    with contextlib.closing(served.connect()) as raw:
        raw.sendall(
            b"POST /v1/sign-in HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
            b'Content-Length: 100\r\n\r\n{"login":'
        )
        answer = raw.recv(65_536)
    assert answer.startswith(b"HTTP/1.1 408")
    assert b"\r\nserver:" not in answer.lower()


def test_a_live_connection_takes_no_large_message(served):
    with connect(f"ws://127.0.0.1:{served.port}/v1/live", additional_headers={"Cookie": served.cookie}) as live:
        live.send("x" * 8_000)
        live.recv(timeout=PATIENCE_S)
        live.send("x" * 9_000)
        with contextlib.suppress(ConnectionClosed):
            while live.recv(timeout=PATIENCE_S):
                pass
        assert live.close_code == 1009


def test_a_flood_is_answered_and_the_live_connection_goes_on(served):
    # How quickly is measured by `ambula bench web flood`; here, that nothing breaks.
    with connect(f"ws://127.0.0.1:{served.port}/v1/live", additional_headers={"Cookie": served.cookie}) as live:
        statuses = []
        with contextlib.closing(served.connect()) as raw:
            stream = raw.makefile("rb")
            for _ in range(2 * CALM):
                raw.sendall(f"GET /v1/me HTTP/1.1\r\nHost: x\r\nCookie: {served.cookie}\r\n\r\n".encode())
                statuses.append(int(stream.readline().split()[1]))
                length = 0
                while (line := stream.readline()) != b"\r\n":
                    if line.lower().startswith(b"content-length:"):
                        length = int(line.split(b":")[1])
                stream.read(length)
        assert set(statuses) <= {200, 429}
        assert statuses == [200] * (CALM - 1) + [429] * (CALM + 1)
        for _ in range(2):
            assert json.loads(live.recv(timeout=PATIENCE_S))["kind"] == "floor"
