"""Whether services of this site run: a restored folder must not be pulled away under them."""

import socket
from contextlib import closing

from schemas.signals import service_token_key
from services.archive.lock import DataFolderLock, DataFolderUnusable
from services.bus.connection import Bus, BusUnavailable
from services.bus.settings import BusSettings
from services.gateway.settings import GatewaySettings

ASK_S = 1.0


def running_services(settings: GatewaySettings, bus_settings: BusSettings) -> list[str]:
    """Names of what runs: services by their tokens, the archive by its lock, the gateway by its port."""
    found = set(_by_token(bus_settings))
    if settings.data_dir.is_dir():
        try:
            with DataFolderLock(settings.data_dir):
                pass
        except DataFolderUnusable:
            found.add("archive")
    if is_answering(settings.http_host, settings.http_port):
        found.add(f"whatever listens on port {settings.http_port}" if "gateway" not in found else "gateway")
    return sorted(found)


def is_answering(host: str, port: int) -> bool:
    """Whether something takes connections there."""
    address = "127.0.0.1" if host in ("0.0.0.0", "::") else host
    try:
        with closing(socket.create_connection((address, port), timeout=ASK_S)):
            return True
    except OSError:
        return False


def _by_token(bus_settings: BusSettings) -> list[str]:
    try:
        with Bus.open(bus_settings, "restore", timeout_s=ASK_S) as bus:
            tokens = bus.tokens(service_token_key(bus_settings.site, "*", "*"))
    except BusUnavailable:
        return []
    return [token.rsplit("/", 2)[1] for token in tokens]
