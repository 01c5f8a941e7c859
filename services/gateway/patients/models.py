"""What the API takes and gives for patients."""

from datetime import datetime
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

YearOfBirth = Annotated[int, Field(ge=1900, le=2100, description="year, Gregorian calendar", examples=[1957])]


class PatientIn(BaseModel):
    """A new patient. The code is drawn by the gateway."""

    model_config = ConfigDict(extra="forbid")

    year_of_birth: YearOfBirth | None = None


class PatientChange(BaseModel):
    """What may be corrected later."""

    model_config = ConfigDict(extra="forbid")

    year_of_birth: YearOfBirth | None


class PatientOut(BaseModel):
    """A patient as a random code."""

    model_config = ConfigDict(extra="forbid")

    code: str = Field(description="random, says nothing about the person", examples=["K7QM3F"])
    year_of_birth: YearOfBirth | None
    created: datetime = Field(description="UTC", examples=["2026-11-22T09:30:00Z"])
    sessions: int = Field(ge=0, description="number of sessions linked to the patient", examples=[3])


class PatientPage(BaseModel):
    """Part of the list, newest first."""

    model_config = ConfigDict(extra="forbid")

    total: int = Field(ge=0, description="number of patients in the whole list", examples=[1])
    items: list[PatientOut]
