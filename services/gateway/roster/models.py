"""What the API gives for the list of patients."""

from datetime import datetime

from pydantic import BaseModel, ConfigDict, Field

from schemas.conditions import SpeedInstruction
from schemas.population import Population, Sex
from schemas.vocabulary import Side, Task
from services.gateway.patients.models import YearOfBirth
from services.progress.rules import Direction, Verdict


class StandingOut(BaseModel):
    """The first measure of the newest test that progress is followed by, against the baseline."""

    model_config = ConfigDict(extra="forbid")

    task: Task = Field(examples=["walk"])
    instruction: SpeedInstruction | None = Field(examples=["comfortable"])
    measure: str = Field(examples=["walking_speed"])
    verdict: Verdict = Field(examples=["real_change"])
    direction: Direction | None = Field(description="of a real change", examples=["better"])


class RosterEntryOut(BaseModel):
    """One patient in the list."""

    model_config = ConfigDict(extra="forbid")

    code: str = Field(description="random, says nothing about the person", examples=["K7QM3F"])
    year_of_birth: YearOfBirth | None
    sex: Sex | None = Field(examples=["female"])
    population: Population | None = Field(examples=["stroke_chronic"])
    paretic_side: Side | None = Field(examples=["left"])
    registered: datetime = Field(description="UTC", examples=["2026-11-22T09:30:00Z"])
    shared: bool = Field(description="whether the patient is another clinic's, shared with the caller")
    visits: int = Field(ge=0, description="number of visits", examples=[3])
    sessions: int = Field(ge=0, description="number of sessions linked to the patient", examples=[4])
    last_visit: datetime | None = Field(
        description="UTC: when the newest session began; null before the first", examples=["2026-11-22T09:30:01Z"]
    )
    standing: StandingOut | None = Field(description="null while there is no baseline that changes count from")


class RosterPage(BaseModel):
    """Part of the list, who came last first."""

    model_config = ConfigDict(extra="forbid")

    total: int = Field(ge=0, description="number of patients that match", examples=[1])
    items: list[RosterEntryOut]
