"""What the API takes and gives for a record as a whole."""

from enum import StrEnum
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Code = Annotated[str, Field(pattern="^[0-9A-Z]{1,16}$", description="patient code", examples=["K7QM3F"])]


class MergeReason(StrEnum):
    """Why two records are one. A word and no free text: it stays in the audit for good."""

    REGISTERED_TWICE = "registered_twice"
    CODE_LOST = "code_lost"


class MergeIn(BaseModel):
    """The record that stays, and why."""

    model_config = ConfigDict(extra="forbid")

    into: Code
    reason: MergeReason = Field(examples=["registered_twice"])


class MergedOut(BaseModel):
    """What the record that stayed was given."""

    model_config = ConfigDict(extra="forbid")

    patient: Code
    sessions: int = Field(ge=0, description="number of sessions that moved", examples=[3])
