"""Commands that ingest takes, and how it answers: the JSON that was asked for, or {"error": reason}."""

import json
from typing import Annotated, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from schemas.conditions import Conditions
from schemas.rhythm import KnownRhythm
from schemas.session import WalkPath
from schemas.vocabulary import Task
from services.ingest.choices import Choices
from services.ingest.errors import SourceError


class InvalidOrder(SourceError):
    """A command that is not understood or cannot be carried out."""


class Order(BaseModel):
    """A command's body. Unknown fields of a newer sender are ignored."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False, extra="ignore")


class StartOrder(Order):
    """Play a source as a session."""

    source: Annotated[str, Field(min_length=1, max_length=4096)]
    speed: Annotated[float, Field(gt=0, le=1000)] | None = Field(description="times real time; null: as followed")
    estimator: str | None = None
    walk_path: WalkPath | None = None
    known_rhythms: list[KnownRhythm] | None = Field(default=None, max_length=3, description="null: as recorded")
    task: Task | None = None
    walkway_m: float | None = Field(default=None, description="m from start to turning point of a timed test")
    conditions: Conditions | None = Field(default=None, description="null: as the source says")
    session: str | None = Field(default=None, description="id; the same order again is answered as the first time")
    ticks: Annotated[int, Field(ge=1, le=5)] = 1

    @property
    def choices(self) -> Choices:
        """What the operator chose. Raises InvalidOption."""
        known = None if self.known_rhythms is None else tuple(self.known_rhythms)
        return Choices(self.estimator, self.walk_path, known, self.task, self.walkway_m, self.conditions)


class MarkOrder(Order):
    """The operator saw the person stand still for the last seconds."""

    session: str
    last_s: Annotated[float, Field(ge=1.0, le=10.0)] = 3.0
    at_s: Annotated[float, Field(ge=0.0, le=1e7)] | None = Field(
        default=None, description="session time on her screen, s; null: the newest sample"
    )


class StopOrder(Order):
    """End a session's streams."""

    session: str


AnyOrder = TypeVar("AnyOrder", bound=Order)


def parse_order(model: type[AnyOrder], body: bytes) -> AnyOrder:
    """Raises InvalidOrder, naming the field."""
    try:
        return model.model_validate_json(body)
    except ValidationError as error:
        fault = error.errors(include_url=False, include_context=False, include_input=False)[0]
        key = ".".join(str(part) for part in fault["loc"]) or "body"
        raise InvalidOrder(f"{key}: {fault['msg']}") from error


def refusal(reason: object) -> bytes:
    """The answer to a command that was not carried out."""
    return json.dumps({"error": str(reason)}).encode()
