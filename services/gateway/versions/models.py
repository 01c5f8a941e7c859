"""What the API gives of a session's results by software version."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from services.gateway.sessions.models import MetricOut
from services.versions.difference import ChangeKind


class MetricChangeOut(BaseModel):
    """One number that is another one, or there in one of two results only."""

    model_config = ConfigDict(extra="forbid")

    name: str = Field(examples=["walking_speed"])
    side: Literal["left", "right"] | None = Field(description="null for the whole body", examples=[None])
    unit: str = Field(description="unit of values and change", examples=["m/s"])
    kind: ChangeKind = Field(examples=["changed"])
    before: MetricOut | None = Field(description="in the former result; null where it is not there")
    after: MetricOut | None = Field(description="in the current result; null where it is not there")
    change: float | None = Field(description="in `unit`: current minus former value", examples=[0.013])
    change_in_intervals: float | None = Field(
        description="change / half the width of the former 95 % interval, dimensionless", examples=[0.4]
    )


class CurveChangeOut(BaseModel):
    """One mean curve that is another one."""

    model_config = ConfigDict(extra="forbid")

    degree_of_freedom: str = Field(examples=["knee_flexion_left"])
    largest: float | None = Field(
        description="rad, the largest distance of the two curves; null where there is one only"
    )


class VersionOut(BaseModel):
    """A session's result as one software version computed it, and how the current one differs."""

    model_config = ConfigDict(extra="forbid")

    software: str = Field(examples=["ambula 0.1.0+1f2e3d4c"])
    current: bool = Field(description="the one that pages, reports and progress use")
    stored: datetime = Field(description="UTC")
    replaced: datetime | None = Field(description="UTC, when a later one took its place; null for the current one")
    files: list[str] = Field(description="its files among the session's recordings, by name")
    identical: bool = Field(description="equal to the current result to the last bit, but for the software")
    metrics: list[MetricChangeOut] = Field(description="from this result to the current one")
    curves: list[CurveChangeOut] = Field(description="from this result to the current one")


class VersionsOut(BaseModel):
    """Results of a session, the current one first."""

    model_config = ConfigDict(extra="forbid")

    session: str = Field(description="session id", examples=["8d0c2a71f04be655"])
    versions: list[VersionOut]
