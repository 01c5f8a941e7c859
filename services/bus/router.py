"""The router inside this process, for one machine. Deployed, the Eclipse Zenoh router takes its place."""

import json
import socket
from typing import Self

import zenoh

from services.bus.connection import base_config
from services.bus.settings import BusSettings


class RouterUnavailable(RuntimeError):
    """The router cannot listen where it should."""


class Router:
    """A running router; a context manager."""

    def __init__(self, session: zenoh.Session, endpoint: str) -> None:
        self.endpoint = endpoint
        self._session = session

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Stop listening; clients look for the next router."""
        self._session.close()  # type: ignore[no-untyped-call]


def choose_endpoint(endpoint: str) -> str:
    """The endpoint itself, with a free port in place of port 0."""
    place, _, port = endpoint.rpartition(":")
    if port != "0":
        return endpoint
    with socket.socket() as probe:
        probe.bind((place.rpartition("/")[2], 0))
        return f"{place}:{probe.getsockname()[1]}"


def open_router(settings: BusSettings) -> Router:
    """Listen on `settings.router`. Raises RouterUnavailable when the port is taken."""
    endpoint = choose_endpoint(settings.router)
    config = base_config()
    config.insert_json5("mode", json.dumps("router"))
    config.insert_json5("listen/endpoints", json.dumps([endpoint]))
    try:
        return Router(zenoh.open(config), endpoint)
    except zenoh.ZError as error:
        raise RouterUnavailable(
            f"cannot listen on {endpoint}: probably another Ambula or Zenoh router runs there. "
            "Stop it, or choose another port with AMBULA_ROUTER=tcp/127.0.0.1:0 (0 takes a free one)"
        ) from error
