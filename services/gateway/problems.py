"""Errors as a client sees them: application/problem+json (RFC 9457) with the next step to take."""

from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ConfigDict, Field
from sqlalchemy.exc import OperationalError
from starlette.exceptions import HTTPException
from starlette.requests import HTTPConnection
from starlette.websockets import WebSocket

from services.gateway.access.statements import OutOfScope
from services.gateway.headers import HEADERS

MEDIA_TYPE = "application/problem+json"

SOCKET_CODE = 4000
"""A live connection that is refused is closed with this and the HTTP status: 4401, 4403."""


class Fault(BaseModel):
    """One thing that is wrong with a request."""

    model_config = ConfigDict(extra="forbid")

    where: str = Field(description="path to the offending value", examples=["body.speed"])
    what: str = Field(description="why it was not accepted", examples=["Input should be greater than 0"])


class ProblemOut(BaseModel):
    """Every error response of this API."""

    model_config = ConfigDict(extra="forbid")

    type: str = Field(description="always about:blank; the title tells the kind", examples=["about:blank"])
    title: str = Field(description="the kind of problem", examples=["Not Found"])
    status: int = Field(description="HTTP status code", examples=[404])
    detail: str = Field(description="what happened", examples=["There is no session 8d0c2a71f04be655."])
    next_step: str = Field(description="what to do about it", examples=["List the sessions with GET /v1/sessions."])
    faults: list[Fault] = Field(description="what exactly is wrong with the request; often empty")


class Problem(Exception):
    """Raised by routes; becomes a problem response. `title` None: the status in words; `retry_after_s`: come then."""

    title: str | None = None
    retry_after_s: int | None = None

    def __init__(self, status: HTTPStatus, detail: str, next_step: str) -> None:
        super().__init__(detail)
        self.status = status
        self.detail = detail
        self.next_step = next_step


def not_found(noun: str, name: str) -> Problem:
    """The thing asked for does not exist (or is not the caller's to see)."""
    return Problem(HTTPStatus.NOT_FOUND, f"There is no {noun} {name}.", f"List what exists with GET /v1/{noun}s.")


def problem_response(
    status: HTTPStatus, detail: str, next_step: str, faults: list[Fault] | None = None, title: str | None = None
) -> JSONResponse:
    """The response for one problem."""
    body = ProblemOut(
        type="about:blank",
        title=title or status.phrase,
        status=status.value,
        detail=detail,
        next_step=next_step,
        faults=faults or [],
    )
    return JSONResponse(body.model_dump(), status_code=status.value, media_type=MEDIA_TYPE)


async def _from_problem(asked: HTTPConnection, error: Exception) -> JSONResponse | None:
    assert isinstance(error, Problem)
    if isinstance(asked, WebSocket):
        # Only an accepted connection can tell a page why it is closed.
        await asked.accept()
        await asked.close(SOCKET_CODE + error.status, error.detail)
        return None
    response = problem_response(error.status, error.detail, error.next_step, title=error.title)
    if error.retry_after_s is not None:
        response.headers["Retry-After"] = str(error.retry_after_s)
    return response


def _from_validation(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, RequestValidationError)
    faults = [Fault(where=".".join(map(str, each["loc"])), what=each["msg"]) for each in error.errors()]
    return problem_response(
        HTTPStatus.UNPROCESSABLE_ENTITY, "The request is not valid.", "Correct the values listed in faults.", faults
    )


def _from_http(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, HTTPException)
    status = HTTPStatus(error.status_code)
    return problem_response(status, str(error.detail), "See /docs for the paths and methods of this API.")


def _from_database(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, OperationalError)
    return problem_response(
        HTTPStatus.SERVICE_UNAVAILABLE,
        "The database does not answer.",
        "Live views go on. Check AMBULA_DATABASE and the disk, then try again.",
    )


def _from_scope(_: Request, error: Exception) -> JSONResponse:
    return problem_response(HTTPStatus.FORBIDDEN, f"This can not be changed from here: {error}.", "Ask their clinic.")


def _from_bug(_: Request, __: Exception) -> JSONResponse:
    # This answer is given outside of all middleware, so it brings the headers itself.
    response = problem_response(
        HTTPStatus.INTERNAL_SERVER_ERROR,
        "The gateway made a mistake.",
        "Report it with the gateway's log of this minute.",
    )
    response.headers.update(HEADERS)
    return response


def install(app: FastAPI) -> None:
    """Make every error of the app a problem."""
    app.add_exception_handler(Problem, _from_problem)  # type: ignore[arg-type]
    app.add_exception_handler(RequestValidationError, _from_validation)
    app.add_exception_handler(HTTPException, _from_http)
    app.add_exception_handler(OutOfScope, _from_scope)
    app.add_exception_handler(OperationalError, _from_database)
    app.add_exception_handler(Exception, _from_bug)


def documented(*statuses: HTTPStatus) -> dict[int | str, dict[str, Any]]:
    """OpenAPI entries for the problems a route can answer with; 422 is among them always."""
    schema = {"schema": {"$ref": "#/components/schemas/ProblemOut"}}
    return {
        status.value: {"description": status.phrase, "content": {MEDIA_TYPE: schema}}
        for status in (*statuses, HTTPStatus.UNPROCESSABLE_ENTITY)
    }
