"""One gateway process, from settings to exit."""

import logging
from functools import partial

import uvicorn

from services.bus.lifetime import call_on_stop
from services.bus.logs import event, set_up_logging
from services.bus.settings import BusSettings
from services.gateway.accounts import first_run
from services.gateway.app import create_app, first_run_code
from services.gateway.bus_control import BusControl
from services.gateway.bus_feed import BusFeed, BusLink
from services.gateway.database import DatabaseError
from services.gateway.live.hub import LiveHub
from services.gateway.settings import GatewaySettings

logger = logging.getLogger(__name__)


def serve() -> int:
    """Serve until SIGTERM or Ctrl-C. Exit code."""
    set_up_logging("gateway")
    for talkative in ("alembic", "uvicorn"):
        logging.getLogger(talkative).setLevel(logging.WARNING)
    settings, live, link = GatewaySettings(), LiveHub(), BusLink()
    try:
        app = create_app(settings, live, BusControl(link))
    except DatabaseError as error:
        logger.error(event("no_database", error=error))
        return 1
    feed = BusFeed(BusSettings(), link, live, app.state.gateway.keeper)
    feed.start()
    config = uvicorn.Config(
        app,
        host=settings.http_host,
        port=settings.http_port,
        server_header=False,
        access_log=False,
        log_config=None,
        ws_max_size=live.parameters.most_socket_bytes,
        ws_per_message_deflate=False,
        timeout_graceful_shutdown=2,
    )
    server = uvicorn.Server(config)
    call_on_stop(partial(setattr, server, "should_exit", True))
    logger.info(event("serving", url=settings.url))
    if first_run_code(app) is not None:
        logger.warning(
            event("first_run", code_in=first_run.code_file(settings.data_dir), open=f"{settings.url}/#/first-run")
        )
    try:
        server.run()
    finally:
        feed.stop()
    return 0
