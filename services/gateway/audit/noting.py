"""What a route tells the audit beside its address: the code it drew, the reason it was given, whose data it showed."""

from dataclasses import dataclass

from starlette.requests import HTTPConnection
from starlette.types import Scope


@dataclass(frozen=True, slots=True)
class Noted:
    """`patients`: one entry each; `object`: what else; `reading`: nothing was changed, although it was a POST."""

    patients: tuple[str, ...] = ()
    session: str | None = None
    object: str | None = None
    reason: str | None = None
    reading: bool = False


NOTHING = Noted()


def note(connection: HTTPConnection, noted: Noted) -> None:
    """Have it in the entry of this request. A request that notes something is in the audit whatever it asks for."""
    connection.state.noted = noted


def noted_in(scope: Scope) -> Noted:
    """What the route of a request has told."""
    noted: Noted = scope.get("state", {}).get("noted", NOTHING)
    return noted
