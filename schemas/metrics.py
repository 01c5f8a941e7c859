"""What a session amounts to so far: numbers with their spread, and mean curves."""

from pydantic import Field

from schemas.gait import CURVE_POINTS
from schemas.payload import Payload, SessionTime


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
