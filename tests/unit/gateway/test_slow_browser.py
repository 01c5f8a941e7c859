"""A browser that opens a live connection and never reads, beside one that does, over real sockets."""

import asyncio
import base64
import contextlib
import json
import os
import socket
import threading
import time

import pytest
import uvicorn
from websockets.sync.client import connect

from services.gateway.access.roles import Role
from services.gateway.app import create_app
from services.gateway.live.hub import LiveHub
from services.gateway.parameters import GatewayParameters
from tests.unit.gateway import people


class Server:
    """uvicorn in a thread on a free port."""

    def __init__(self, app) -> None:
        self.app = app
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        config = uvicorn.Config(
            app, log_config=None, server_header=False, access_log=False, timeout_graceful_shutdown=1
        )
        self.server = uvicorn.Server(config)
        self.thread = threading.Thread(target=lambda: asyncio.run(self.server.serve(sockets=[self.listener])))

    def __enter__(self):
        self.thread.start()
        deadline = time.monotonic() + 20
        while not self.server.started:
            assert time.monotonic() < deadline
            time.sleep(0.01)
        return self

    def __exit__(self, *_) -> None:
        self.server.should_exit = True
        self.thread.join(20)
        self.listener.close()


@pytest.fixture
def stalling(settings, control):
    settings.http_names = ["*"]
    hub = LiveHub(GatewayParameters(stall_s=0.5, pose_interval_s=0.005))
    with Server(create_app(settings, hub, control)) as server:
        yield server, hub, people.cookie(server.app, Role.VIEWER)


def open_and_never_read(port: int, cookie: str) -> socket.socket:
    """The handshake by hand, with the smallest receive buffer the system gives."""
    raw = socket.socket()
    raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1)
    raw.connect(("127.0.0.1", port))
    key = base64.b64encode(os.urandom(16)).decode()
    raw.sendall(
        f"GET /v1/live/a HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        f"Cookie: {cookie}\r\n"
        f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
    )
    assert b"101" in raw.recv(64)
    return raw


def test_the_stalled_browser_is_dropped_and_the_other_sees_everything_go_on(stalling, made):
    server, hub, cookie = stalling
    hub.open(made.describe("a"))
    hub.assign("a", None, "main")
    wide = made.pose_at(1.0).model_copy(update={"message": "x" * 60_000})
    with (
        contextlib.closing(open_and_never_read(server.port, cookie)),
        connect(
            f"ws://127.0.0.1:{server.port}/v1/live/a",
            additional_headers={"Cookie": cookie},
            max_size=None,
            compression=None,
        ) as quick,
    ):
        live = hub._sessions["a"]
        deadline = time.monotonic() + 20
        while len(live.viewers) < 2:
            assert time.monotonic() < deadline
            time.sleep(0.01)
        number = 1
        while len(live.viewers) == 2:
            assert time.monotonic() < deadline, "the stalled browser was never dropped"
            number += 1
            hub.pose("a", wide.model_copy(update={"captured_ns": number * 1_000_000_000}).model_dump_json().encode())
            while True:
                message = json.loads(quick.recv(timeout=10))
                if message["kind"] == "pose" and message["at_s"] == number:
                    break
        assert number > 5
        hub.pose("a", made.pose_at(9999.0).model_dump_json().encode())
        while json.loads(quick.recv(timeout=10)).get("at_s") != 9999.0:
            pass
