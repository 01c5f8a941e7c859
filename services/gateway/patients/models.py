"""What the API takes and gives for patients."""

from datetime import datetime
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from schemas.population import Population, Sex
from schemas.vocabulary import Side

YearOfBirth = Annotated[int, Field(ge=1900, le=2100, description="year, Gregorian calendar", examples=[1957])]


class PatientIn(BaseModel):
    """A new patient. The code is drawn by the gateway; what is not known is left out."""

    model_config = ConfigDict(extra="forbid")

    year_of_birth: YearOfBirth | None = None
    sex: Sex | None = Field(default=None, description="as reference values are divided", examples=["female"])
    population: Population | None = Field(
        default=None, description="decides which published thresholds fit", examples=["stroke_chronic"]
    )
    paretic_side: Side | None = Field(default=None, description="the more affected side", examples=["left"])


class PatientChange(PatientIn):
    """What may be corrected later. What is left out stays; null takes it out."""


class PatientOut(BaseModel):
    """A patient as a random code."""

    model_config = ConfigDict(extra="forbid")

    code: str = Field(description="random, says nothing about the person", examples=["K7QM3F"])
    year_of_birth: YearOfBirth | None
    sex: Sex | None = Field(examples=["female"])
    population: Population | None = Field(examples=["stroke_chronic"])
    paretic_side: Side | None = Field(examples=["left"])
    created: datetime = Field(description="UTC", examples=["2026-11-22T09:30:00Z"])
    sessions: int = Field(ge=0, description="number of sessions linked to the patient", examples=[3])


class PatientPage(BaseModel):
    """Part of the list, newest first."""

    model_config = ConfigDict(extra="forbid")

    total: int = Field(ge=0, description="number of patients in the whole list", examples=[1])
    items: list[PatientOut]
