"""What every route can reach, and the parameters that routes share."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Annotated

from fastapi import Depends, Path, Query
from prometheus_client import CollectorRegistry
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from services.gateway.access.caller import Caller
from services.gateway.access.identify import Identified
from services.gateway.accounts.passwords import Passwords
from services.gateway.control import Control
from services.gateway.database import Database
from services.gateway.directory.store import NameDirectory
from services.gateway.erasure.eraser import Eraser
from services.gateway.live.hub import LiveHub
from services.gateway.parameters import GatewayParameters
from services.gateway.sessions.keeper import SessionKeeper
from services.gateway.settings import GatewaySettings


@dataclass(frozen=True)
class Gateway:
    """The parts of one running gateway, and who asks for them; `caller` None: nobody yet."""

    settings: GatewaySettings
    parameters: GatewayParameters
    database: Database
    keeper: SessionKeeper
    live: LiveHub
    control: Control
    passwords: Passwords
    numbers: CollectorRegistry
    directory: NameDirectory
    eraser: Eraser
    caller: Caller | None = None

    @property
    def known_caller(self) -> Caller:
        """Who asks, in a route that needs somebody known."""
        assert self.caller is not None
        return self.caller

    @contextmanager
    def transaction(self) -> Iterator[Session]:
        """A transaction in which only what the caller may see exists."""
        with self.database.transaction(self.known_caller.scope) as database:
            yield database


def of(connection: HTTPConnection) -> Gateway:
    """The gateway that a request or socket came to."""
    gateway = connection.app.state.gateway
    assert isinstance(gateway, Gateway)
    return gateway


def of_caller(connection: HTTPConnection, caller: Identified) -> Gateway:
    """The gateway as the caller may use it. Raises a 401 problem when nobody known asks."""
    return replace(of(connection), caller=caller)


Context = Annotated[Gateway, Depends(of_caller)]
Parts = Annotated[Gateway, Depends(of)]
"""For routes that anybody may call, and for the caller's own account."""

Offset = Annotated[int, Query(ge=0, description="number of entries to leave out")]
Limit = Annotated[int, Query(ge=1, le=100, description="number of entries at most")]
SessionId = Annotated[
    str, Path(pattern="^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$", description="session id", examples=["8d0c2a71f04be655"])
]
PatientCode = Annotated[str, Path(pattern="^[0-9A-Z]{1,16}$", description="patient code", examples=["K7QM3F"])]
