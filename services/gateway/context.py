"""What every route can reach, and the parameters that routes share."""

from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends, Path, Query
from starlette.requests import HTTPConnection

from services.gateway.control import Control
from services.gateway.database import Database
from services.gateway.live.hub import LiveHub
from services.gateway.parameters import GatewayParameters
from services.gateway.sessions.keeper import SessionKeeper
from services.gateway.settings import GatewaySettings


@dataclass(frozen=True)
class Gateway:
    """The parts of one running gateway."""

    settings: GatewaySettings
    parameters: GatewayParameters
    database: Database
    keeper: SessionKeeper
    live: LiveHub
    control: Control


def of(connection: HTTPConnection) -> Gateway:
    """The gateway that a request or socket came to."""
    gateway = connection.app.state.gateway
    assert isinstance(gateway, Gateway)
    return gateway


Context = Annotated[Gateway, Depends(of)]

Offset = Annotated[int, Query(ge=0, description="number of entries to leave out")]
Limit = Annotated[int, Query(ge=1, le=100, description="number of entries at most")]
SessionId = Annotated[
    str, Path(pattern="^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$", description="session id", examples=["8d0c2a71f04be655"])
]
PatientCode = Annotated[str, Path(pattern="^[0-9A-Z]{1,16}$", description="patient code", examples=["K7QM3F"])]
