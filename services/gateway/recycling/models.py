"""What the API gives of the bin."""

from datetime import date, datetime

from pydantic import BaseModel, ConfigDict, Field

from schemas.vocabulary import Task


class BinPatientOut(BaseModel):
    """A patient in the bin."""

    model_config = ConfigDict(extra="forbid")

    code: str = Field(description="patient code", examples=["K7QM3F"])
    deleted: datetime = Field(description="UTC", examples=["2026-11-22T09:30:00Z"])
    erased_on: date = Field(description="UTC day on which it is erased for good", examples=["2026-12-22"])
    sessions: int = Field(ge=0, description="number of sessions that went with the patient", examples=[3])


class BinSessionOut(BaseModel):
    """A session in the bin."""

    model_config = ConfigDict(extra="forbid")

    id: str = Field(description="session id", examples=["8d0c2a71f04be655"])
    patient: str | None = Field(description="patient code; null while unassigned", examples=["K7QM3F"])
    task: Task | None = Field(examples=["walk"])
    created: datetime = Field(description="UTC", examples=["2026-11-22T09:30:00Z"])
    deleted: datetime = Field(description="UTC", examples=["2026-11-22T09:30:00Z"])
    erased_on: date = Field(description="UTC day on which it is erased for good", examples=["2026-12-22"])


class BinOut(BaseModel):
    """What can still be brought back, the last deleted first."""

    model_config = ConfigDict(extra="forbid")

    keep_days: int = Field(ge=0, description="days that something stays here", examples=[30])
    patients: list[BinPatientOut] = Field(description="the newest 500")
    sessions: list[BinSessionOut] = Field(description="those that went without their patient; the newest 500")


class RestoredOut(BaseModel):
    """What was brought back."""

    model_config = ConfigDict(extra="forbid")

    patient: str | None = Field(description="patient code", examples=["K7QM3F"])
    sessions: int = Field(ge=0, description="number of sessions", examples=[3])
