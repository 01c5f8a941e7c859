"""What the API takes and gives for treatments."""

import datetime as dt

from pydantic import BaseModel, ConfigDict, Field

from services.progress.treatments import TreatmentKind


class TreatmentIn(BaseModel):
    """Something that was done for a patient on one day."""

    model_config = ConfigDict(extra="forbid")

    date: dt.date = Field(description="day, Gregorian calendar", examples=["2026-11-02"])
    kind: TreatmentKind = Field(examples=["botulinum_toxin"])


class TreatmentOut(TreatmentIn):
    """A stored treatment."""

    id: int = Field(description="number to delete it by", examples=[7])


class TreatmentPage(BaseModel):
    """Part of a patient's treatments, newest first."""

    model_config = ConfigDict(extra="forbid")

    total: int = Field(ge=0, description="number of all treatments", examples=[1])
    items: list[TreatmentOut]
