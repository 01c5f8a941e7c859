"""What the API gives of the audit."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field


class AuditEntryOut(BaseModel):
    """Who did what with what, and how it ended. Ids and codes only, never a name."""

    model_config = ConfigDict(extra="forbid")

    number: int = Field(ge=1, description="place in the chain, dimensionless", examples=[1042])
    at: datetime = Field(description="UTC", examples=["2026-11-22T09:30:00Z"])
    actor_kind: str = Field(description="person, machine, housekeeping or nobody", examples=["person"])
    actor: str | None = Field(description="id of the account or key", examples=["8d0c2a71f04be655"])
    role: str | None = Field(examples=["therapist"])
    clinic: str | None = Field(description="id of the actor's clinic", examples=["main"])
    action: str = Field(description="name of the operation", examples=["read_patient"])
    patient: str | None = Field(description="patient code", examples=["K7QM3F"])
    session: str | None = Field(description="session id", examples=[None])
    object: str | None = Field(description="what else it was about", examples=[None])
    outcome: int = Field(description="HTTP status; 101 for a live connection, dimensionless", examples=[200])
    reason: str | None = Field(description="why, where the operation asks for it", examples=[None])
    previous: str = Field(description="SHA-256 of the entry before, hexadecimal")
    digest: str = Field(description="SHA-256 of this entry and the one before, hexadecimal")


class AuditPage(BaseModel):
    """Part of the audit, newest first."""

    model_config = ConfigDict(extra="forbid")

    total: int = Field(ge=0, description="number of entries that match", examples=[1])
    items: list[AuditEntryOut]


class VerificationOut(BaseModel):
    """Whether the whole chain, of all clinics, is as it was written."""

    model_config = ConfigDict(extra="forbid")

    intact: bool
    entries: int = Field(ge=0, description="number of entries that hang together, from the first", examples=[1042])
    broken_entry: int | None = Field(description="number of the first entry that is not as it was", examples=[None])
    fault: str | None = Field(description="what is wrong there, and what to do", examples=[None])
    signed_entry: int | None = Field(description="number of the newest entry that a signature covers", examples=[1000])
    signed_at: datetime | None = Field(description="UTC; null before the first signature")


ExportFormat = Literal["ndjson", "fhir"]
