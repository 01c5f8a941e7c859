"""From a request or socket to a caller: a browser's cookie, or a machine's key."""

from datetime import UTC, datetime
from http import HTTPStatus
from typing import Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

from services.gateway.access import keys, sign_ins
from services.gateway.access.caller import Caller
from services.gateway.access.scope import EVERYTHING
from services.gateway.database import Database
from services.gateway.problems import Problem

COOKIE = "ambula"
SECURE_COOKIE = "__Host-ambula"
"""Over TLS. The prefix makes browsers refuse one that another host or a plain connection has set."""


class NotKnown(Problem):
    """Nobody that is known here."""

    def __init__(self, detail: str = "You are not signed in, or no longer.") -> None:
        super().__init__(HTTPStatus.UNAUTHORIZED, detail, "Sign in, or send a valid key as a bearer token.")


def cookie_of(connection: HTTPConnection) -> str | None:
    """The sign-in that the browser holds."""
    return connection.cookies.get(cookie_name(connection))


def cookie_name(connection: HTTPConnection) -> str:
    """The cookie's name on this kind of connection."""
    return SECURE_COOKIE if is_secure(connection) else COOKIE


def is_secure(connection: HTTPConnection) -> bool:
    """Whether the browser came over TLS: to this process, or to a proxy at the public address before it."""
    public: str = connection.app.state.gateway.settings.public_url
    behind = public.startswith("https://") and connection.headers.get("host") == public.removeprefix("https://")
    return behind or connection.url.scheme in ("https", "wss")


def identify(connection: HTTPConnection) -> Caller:
    """Who is asking. Raises NotKnown. The audit finds the caller in the connection's state."""
    database: Database = connection.app.state.gateway.database
    caller = _caller(database, connection)
    connection.state.caller = caller
    return caller


def identify_again(connection: HTTPConnection) -> Caller:
    """Who is asking, some time after `identify`, over a connection that stays open. Raises NotKnown.

    Not by the cookie: the one that the connection was opened with has been renewed since.
    """
    before: Caller = connection.state.caller
    if before.sign_in is None:
        return identify(connection)
    gateway = connection.app.state.gateway
    database: Database = gateway.database
    with database.transaction(EVERYTHING) as session:
        caller = sign_ins.find_again(session, before.sign_in, datetime.now(UTC), gateway.parameters)
    if caller is None:
        raise NotKnown
    connection.state.caller = caller
    return caller


def _caller(database: Database, connection: HTTPConnection) -> Caller:
    scheme, _, key = connection.headers.get("authorization", "").partition(" ")
    parameters = connection.app.state.gateway.parameters
    now = datetime.now(UTC)
    with database.transaction(EVERYTHING) as session:
        if scheme:
            caller = keys.find_caller(session, key, now) if scheme.lower() == "bearer" else None
        else:
            caller = sign_ins.find_caller(session, cookie_of(connection), now, parameters)
    if caller is None:
        raise NotKnown
    return caller


Identified = Annotated[Caller, Depends(identify)]


def person(caller: Identified) -> Caller:
    """Somebody who has signed in. Raises a 403 problem for a machine."""
    if caller.kind != "person":
        raise Problem(HTTPStatus.FORBIDDEN, "A key may not do this.", "Sign in as a person.")
    return caller


Person = Annotated[Caller, Depends(person)]
