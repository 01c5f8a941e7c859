"""What the API gives for visits."""

from datetime import date, datetime

from pydantic import BaseModel, ConfigDict, Field

from schemas.conditions import Conditions
from schemas.vocabulary import Task
from services.gateway.sessions.models import MetricOut, SessionState


class VisitSessionOut(BaseModel):
    """One session of a visit, with its headline metrics."""

    model_config = ConfigDict(extra="forbid")

    session: str = Field(description="session id", examples=["8d0c2a71f04be655"])
    title: str = Field(examples=["Synthetic walk, 1.1 m/s"])
    began: datetime = Field(description="UTC", examples=["2026-11-22T09:30:01Z"])
    duration_s: float | None = Field(description="s", examples=[60.0])
    state: SessionState = Field(examples=["finished"])
    task: Task | None = Field(description="what the person was asked to do; null before the start", examples=["walk"])
    conditions: Conditions | None = Field(description="how the test was done; null before the start")
    estimator: str = Field(examples=["rhythmic_ekf"])
    software: str | None = Field(description="what computed the metrics; null before them", examples=["ambula 0.1.0"])
    usable: bool = Field(description="whether progress may count from it: final, said how it was done, trusted")
    metrics: list[MetricOut] = Field(description="headline metrics; empty before the first metrics")


class VisitOut(BaseModel):
    """Sessions of which each began within 12 h after the first."""

    model_config = ConfigDict(extra="forbid")

    visit: int = Field(ge=1, description="number of the visit, 1 for the first", examples=[3])
    day: date = Field(description="UTC date of the first session", examples=["2026-11-22"])
    baseline: bool = Field(description="whether progress counts from this visit")
    sessions: list[VisitSessionOut] = Field(description="in the order in which they began")


class VisitPage(BaseModel):
    """Part of a patient's visits, newest first."""

    model_config = ConfigDict(extra="forbid")

    total: int = Field(ge=0, description="number of all visits", examples=[6])
    items: list[VisitOut]
