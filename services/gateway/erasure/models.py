"""What the API takes and gives for erasing."""

from enum import StrEnum

from pydantic import BaseModel, ConfigDict, Field


class ErasureReason(StrEnum):
    """Why somebody is erased. A word and no free text: it outlives the person's data."""

    REQUESTED = "requested_by_patient"
    CONSENT_WITHDRAWN = "consent_withdrawn"
    MISTAKE = "registered_by_mistake"
    TEST = "test_entry"


class ErasureIn(BaseModel):
    """Erase for good."""

    model_config = ConfigDict(extra="forbid")

    reason: ErasureReason = Field(examples=["requested_by_patient"])


class ErasureOut(BaseModel):
    """What was erased."""

    model_config = ConfigDict(extra="forbid")

    sessions: int = Field(ge=0, description="number of sessions that were erased", examples=[3])
    recordings_left: int = Field(
        ge=0,
        description="number of recordings that the archive could not remove yet; it is ordered again by itself",
        examples=[0],
    )
