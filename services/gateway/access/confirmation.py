"""What can not be undone asks for the password once more: `Confirmed` as a parameter or dependency of a route."""

from datetime import UTC, datetime, timedelta
from http import HTTPStatus
from typing import Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

from services.gateway.access.identify import Person
from services.gateway.problems import Problem

TITLE = "Confirm your password"


class NotConfirmed(Problem):
    """The password has to be given once more."""

    title = TITLE

    def __init__(self) -> None:
        super().__init__(
            HTTPStatus.FORBIDDEN,
            "This needs your password once more, as it can not be undone.",
            "Confirm it with POST /v1/sign-in/confirmation, then ask again within five minutes.",
        )


def require_confirmation(connection: HTTPConnection, caller: Person) -> None:
    """Raises a 403 problem unless the caller is a person who gave the password a short while ago."""
    confirmed_s: float = connection.app.state.gateway.parameters.confirmed_s
    if caller.confirmed is None or datetime.now(UTC) - caller.confirmed > timedelta(seconds=confirmed_s):
        raise NotConfirmed


CONFIRMED = Depends(require_confirmation)
Confirmed = Annotated[None, CONFIRMED]
"""For routes: `def erase(..., _: Confirmed)`."""
