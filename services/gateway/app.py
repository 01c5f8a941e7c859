"""The web application: routes, errors, headers and the parts behind them."""

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from functools import partial
from importlib.metadata import version
from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

from services.gateway import pages, problems
from services.gateway.access.rules import check_rules, described
from services.gateway.access.scope import EVERYTHING
from services.gateway.accounts import first_run
from services.gateway.accounts.housekeeping import forget_expired_sign_ins
from services.gateway.accounts.oidc.routes import OidcServices
from services.gateway.accounts.passwords import Passwords
from services.gateway.accounts.records import has_accounts
from services.gateway.audit.heads import Heads
from services.gateway.audit.trail import AuditTrail
from services.gateway.context import Gateway
from services.gateway.control import Control
from services.gateway.database import DatabaseError, open_database
from services.gateway.directory.store import NameDirectory
from services.gateway.erasure.eraser import Eraser
from services.gateway.erasure.housekeeping import Housekeeping
from services.gateway.erasure.tombstones import Tombstones, TombstonesUnreadable
from services.gateway.housekeeping import keep_house
from services.gateway.limits import RateLimit
from services.gateway.live.hub import LiveHub
from services.gateway.monitoring.requests import CountRequests, RequestNumbers
from services.gateway.monitoring.site import site_registry
from services.gateway.problems import ProblemOut
from services.gateway.routers import ROUTERS, ROUTES
from services.gateway.security import BodyLimit, HostNames, SecurityHeaders
from services.gateway.sessions.keeper import SessionKeeper
from services.gateway.settings import GatewaySettings

DESCRIPTION = "Patients, sessions, metrics and recordings of one Ambula site. Research software, not a medical device."


def create_app(settings: GatewaySettings, live: LiveHub, control: Control) -> FastAPI:
    """Put the gateway together. Opens the database; raises DatabaseError when it cannot be used."""
    gateway = _gateway(settings, live, control)
    app = FastAPI(
        title="Ambula",
        version=version("ambula"),
        description=DESCRIPTION,
        lifespan=lambda _: _life(gateway),
        docs_url=None,
        redoc_url=None,
        openapi_url="/v1/openapi.json",
    )
    app.state.gateway = gateway
    app.state.oidc = OidcServices(settings.oidc)
    problems.install(app)
    check_rules(ROUTES)
    for router in ROUTERS:
        app.include_router(router)
    pages.install(app, settings.pages_dir)
    _guard(app, gateway)
    app.openapi = lambda: _openapi(app)  # type: ignore[method-assign]
    return app


def _gateway(settings: GatewaySettings, live: LiveHub, control: Control) -> Gateway:
    database = open_database(settings.database_url)
    keeper = SessionKeeper(database, live, live.parameters, settings.clinic)
    directory = NameDirectory(settings.directory_url, settings.directory_key)
    numbers = site_registry(live, database, settings.data_dir)
    stones = Tombstones(settings.own_dir)
    eraser = Eraser(database, directory, stones, settings.data_dir, keeper, live, control)
    _erase_again(eraser)
    return Gateway(settings, live.parameters, database, keeper, live, control, Passwords(), numbers, directory, eraser)


@asynccontextmanager
async def _life(gateway: Gateway) -> AsyncIterator[None]:
    gateway.live.bind(asyncio.get_running_loop())
    house = asyncio.create_task(keep_house(_jobs(gateway)))
    yield
    house.cancel()
    # A job that is under way ends before the database is closed.
    with suppress(asyncio.CancelledError):
        await house
    await gateway.live.stop()
    gateway.directory.close()
    gateway.database.close()


def _jobs(gateway: Gateway) -> dict[str, Callable[[], object]]:
    """What is done now and then, by name."""
    house_rules = Housekeeping(gateway.eraser, Heads(gateway.settings.own_dir), gateway.parameters)
    return {
        "sign_ins": partial(forget_expired_sign_ins, gateway.database, gateway.parameters),
        "bin": house_rules.empty_bin,
        "retention": house_rules.keep_no_longer,
        "recordings": house_rules.remove_recordings,
        "audit": house_rules.sign_audit,
    }


def _guard(app: FastAPI, gateway: Gateway) -> None:
    """What every request passes, the innermost first."""
    bounds = gateway.parameters
    app.add_middleware(AuditTrail, database=gateway.database)
    app.add_middleware(BodyLimit, most_bytes=bounds.most_body_bytes, within_s=bounds.body_within_s)
    app.add_middleware(HostNames, names=gateway.settings.host_names)
    app.add_middleware(RateLimit, parameters=bounds)
    app.add_middleware(CountRequests, numbers=RequestNumbers(gateway.numbers))
    app.add_middleware(SecurityHeaders)


def _erase_again(eraser: Eraser) -> None:
    try:
        eraser.apply_again()
    except TombstonesUnreadable as error:
        raise DatabaseError(f"who was erased can not be told: {error}") from error


def first_run_code(app: FastAPI) -> str | None:
    """The code for the first administrator, written where the gateway's user can read it; None when it is past."""
    gateway: Gateway = app.state.gateway
    with gateway.database.transaction(EVERYTHING) as database:
        if has_accounts(database):
            return None
    return first_run.write_code(gateway.settings.own_dir)


def _openapi(app: FastAPI) -> dict[str, Any]:
    # Problem responses refer to ProblemOut by name; it is no route's own model, so it is added by hand.
    if app.openapi_schema is None:
        document = get_openapi(title=app.title, version=app.version, description=app.description, routes=app.routes)
        schema = ProblemOut.model_json_schema(ref_template="#/components/schemas/{model}")
        parts = document["components"]["schemas"]
        parts.update(schema.pop("$defs"))
        parts["ProblemOut"] = schema
        for unused in ("HTTPValidationError", "ValidationError"):
            parts.pop(unused, None)
        described(ROUTES, document)
        app.openapi_schema = document
    return app.openapi_schema
