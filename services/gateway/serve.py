"""One gateway process, from settings to exit."""

import logging
from functools import partial

import uvicorn
from starlette.types import ASGIApp

from services.bus.lifetime import call_on_stop
from services.bus.logs import event, set_up_logging
from services.bus.settings import BusSettings
from services.gateway.accounts import first_run
from services.gateway.app import create_app, first_run_code
from services.gateway.bus_control import BusControl
from services.gateway.bus_feed import BusFeed, BusLink
from services.gateway.certificate import Certificate, CertificateError, read_pair
from services.gateway.connections import MOST_CONNECTIONS, BoundedHttp
from services.gateway.database import DatabaseError
from services.gateway.live.hub import LiveHub
from services.gateway.parameters import GatewayParameters
from services.gateway.settings import GatewaySettings

logger = logging.getLogger(__name__)


def serve() -> int:
    """Serve until SIGTERM or Ctrl-C. Exit code."""
    set_up_logging("gateway")
    for talkative in ("alembic", "uvicorn"):
        logging.getLogger(talkative).setLevel(logging.WARNING)
    settings, live, link = GatewaySettings(), LiveHub(), BusLink()
    try:
        certificate = checked_certificate(settings)
        app = create_app(settings, live, BusControl(link))
    except DatabaseError as error:
        logger.error(event("no_database", error=error))
        return 1
    except CertificateError as error:
        logger.error(event("no_certificate", error=error))
        return 1
    feed = BusFeed(BusSettings(), link, live, app.state.gateway.keeper)
    feed.start()
    server = uvicorn.Server(config_of(app, settings, live.parameters))
    call_on_stop(partial(setattr, server, "should_exit", True))
    until = None if certificate is None else certificate.ends.date()
    logger.info(event("serving", url=settings.url, certificate_until=until))
    if first_run_code(app) is not None:
        logger.warning(
            event("first_run", code_in=first_run.code_file(settings.own_dir), open=f"{settings.url}/#/first-run")
        )
    try:
        server.run()
    finally:
        feed.stop()
    return 0


def checked_certificate(settings: GatewaySettings) -> Certificate | None:
    """What the page's certificate says; None without TLS. Raises CertificateError when it cannot be used."""
    if settings.http_certificate is None or settings.http_key is None:
        return None
    return read_pair(settings.http_certificate, settings.http_key)


def config_of(app: ASGIApp, settings: GatewaySettings, parameters: GatewayParameters) -> uvicorn.Config:
    """How the application is served: with TLS where there is a certificate (1.2 or newer, as Python's defaults say)."""
    return uvicorn.Config(
        app,
        host=settings.http_host,
        port=settings.http_port,
        ssl_certfile=settings.http_certificate,
        ssl_keyfile=settings.http_key,
        http=BoundedHttp,
        limit_concurrency=MOST_CONNECTIONS,
        server_header=False,
        access_log=False,
        log_config=None,
        ws_max_size=parameters.most_socket_bytes,
        ws_per_message_deflate=False,
        timeout_graceful_shutdown=2,
    )
