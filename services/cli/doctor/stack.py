"""What runs: services by their tokens, ports by who answers there."""

import json
import socket
import ssl
import urllib.request
from collections.abc import Iterator
from contextlib import closing

from schemas.signals import service_token_key
from services.bus.connection import Bus, BusUnavailable
from services.bus.settings import BusSettings
from services.cli.backup.running import is_answering
from services.cli.doctor.findings import Finding
from services.gateway.settings import GatewaySettings

SERVICES = ("ingest", "estimation", "segmentation", "metrics", "archive", "gateway")
ASK_S = 3.0


def service_is_alive(service: str) -> bool:
    """Whether a service of that name holds its token on the configured router."""
    try:
        with Bus.open(BusSettings(), "doctor") as bus:
            return bool(bus.tokens(service_token_key(bus.settings.site, service, "*")))
    except BusUnavailable:
        return False


def findings(gateway: GatewaySettings) -> Iterator[Finding]:
    """Ports first, then each service."""
    settings = BusSettings()
    try:
        with Bus.open(settings, "doctor") as bus:
            yield Finding("Router", True, f"answers at {settings.router}")
            yield page_port(gateway)
            for name in SERVICES:
                alive = len(bus.tokens(service_token_key(settings.site, name, "*")))
                yield Finding(name, alive > 0, f"{alive} running" if alive else "not running; see its log")
    except BusUnavailable:
        yield router_port(settings.router)
        yield page_port(gateway)


def router_port(endpoint: str) -> Finding:
    """Of a router that does not answer."""
    host, _, port = endpoint.partition("/")[2].rpartition(":")
    if port.isdigit() and is_answering(host, int(port)):
        return Finding(
            "Router", False, f"port {port} is taken by another program; end it, or choose another in AMBULA_ROUTER"
        )
    return Finding("Router", None, f"no router at {endpoint}; `ambula up` starts one")


def page_port(settings: GatewaySettings) -> Finding:
    """Whether the page's port is ours, free, or somebody else's."""
    port = settings.http_port
    if is_answering(settings.http_host, port):
        if is_ours(settings):
            return Finding("Port", True, f"{port}: the gateway answers at {settings.url}")
        return Finding("Port", False, f"{port} is taken by another program; end it, or set AMBULA_HTTP_PORT")
    with closing(socket.socket()) as free:
        free.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            free.bind((settings.http_host, port))
        except OSError as error:
            return Finding(
                "Port", False, f"{settings.http_host}:{port} cannot be had ({error.strerror}); set AMBULA_HTTP_PORT"
            )
    return Finding("Port", True, f"{port} is free")


def is_ours(settings: GatewaySettings) -> bool:
    """Whether a gateway of Ambula answers at the page's address."""
    # What answers is asked for nothing but whether it is a gateway, so its certificate need not be believed.
    context = ssl._create_unverified_context() if settings.is_secure else None
    try:
        with urllib.request.urlopen(f"{settings.url}/v1/sign-in", timeout=ASK_S, context=context) as answer:
            return "first_run" in json.loads(answer.read(100_000))
    except (OSError, ValueError):
        return False
