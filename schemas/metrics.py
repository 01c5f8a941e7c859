"""What a session amounts to so far: numbers with their spread, and mean curves."""

from typing import Any

from pydantic import Field, model_validator

from schemas.gait import CURVE_POINTS
from schemas.payload import Payload, SessionTime
from schemas.tasks import Repetition, TaskPhase


class Metric(Payload):
    """One number of a session or of one side."""

    name: str
    side: str | None = Field(description="left, right, or null for the whole body")
    unit: str = Field(description="unit of value, mean_std and spread")
    value: float | None = Field(description="in `unit`; null when it was withheld")
    spread: float | None = Field(description="in `unit`: standard deviation over the strides")
    mean_std: float | None = Field(description="in `unit`: standard error of the value")
    strides: int = Field(ge=0, description="number of strides it rests on")
    withheld_because: str | None


class MeanCurve(Payload):
    """Mean and spread of one joint over 0-100 % of the stride."""

    degree_of_freedom: str
    strides: int = Field(ge=0, description="number of strides it rests on")
    mean: list[float] = Field(min_length=CURVE_POINTS, max_length=CURVE_POINTS, description="rad at 0 ... 100 %")
    spread: list[float] = Field(min_length=CURVE_POINTS, max_length=CURVE_POINTS, description="rad at 0 ... 100 %")


class SessionMetrics(Payload):
    """All metrics of a session up to `captured_ns`; the last one of a session is final."""

    captured_ns: SessionTime
    final: bool
    metrics: list[Metric]
    curves: list[MeanCurve]
    phases: list[TaskPhase] = Field(max_length=500, description="of timed tests so far, in order; the first 500")
    repetitions: list[Repetition] = Field(max_length=1000, description="in order, when final; the first 1000")

    @model_validator(mode="before")
    @classmethod
    def _of_an_older_writer(cls, fields: Any) -> Any:
        """Earlier ones knew of walking only."""
        return {"phases": [], "repetitions": [], **fields} if isinstance(fields, dict) else fields
