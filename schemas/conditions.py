"""How a test was done, as far as somebody said so. Results are compared only where these agree."""

from enum import StrEnum
from typing import Any

from pydantic import Field, model_validator

from schemas.payload import Payload
from schemas.vocabulary import Side


class WalkingAid(StrEnum):
    """What a person holds on to while walking."""

    NONE = "none"
    CANE = "cane"
    QUAD_CANE = "quad_cane"
    CRUTCHES = "crutches"
    WALKING_FRAME = "walking_frame"
    ROLLATOR = "rollator"
    PARALLEL_BARS = "parallel_bars"
    OTHER = "other"


class Orthosis(StrEnum):
    """What is strapped to a leg to hold it."""

    NONE = "none"
    ANKLE_FOOT = "ankle_foot"
    KNEE_ANKLE_FOOT = "knee_ankle_foot"
    KNEE = "knee"
    OTHER = "other"


class Footwear(StrEnum):
    """What is on the feet."""

    SHOES = "shoes"
    SOCKS = "socks"
    BAREFOOT = "barefoot"


class SpeedInstruction(StrEnum):
    """How fast the person was asked to walk."""

    COMFORTABLE = "comfortable"
    FAST = "fast"


class Start(StrEnum):
    """Whether the person stands or walks where a test's distance begins."""

    STANDING = "standing"
    WALKING = "walking"


class Conditions(Payload):
    """Null is what nobody said. No free text: nothing here identifies anybody."""

    paretic_side: Side | None = Field(description="the more affected side; null: none declared")
    aid: WalkingAid | None
    orthosis: Orthosis | None
    footwear: Footwear | None
    physical_assistance: bool | None = Field(description="somebody held or supported the person")
    speed_instruction: SpeedInstruction | None
    start: Start | None = Field(description="of a ten-metre walk")
    timed_from_m: float | None = Field(ge=0, le=100, description="m from the start: where the timed zone begins")
    timed_to_m: float | None = Field(gt=0, le=100, description="m from the start: where the timed zone ends")
    test_duration_s: float | None = Field(gt=0, le=3600, description="s that a walk for time lasts")

    @model_validator(mode="before")
    @classmethod
    def _unsaid(cls, fields: Any) -> Any:
        """What is left out was not said."""
        return {**dict.fromkeys(cls.model_fields), **fields} if isinstance(fields, dict) else fields


UNSAID = Conditions.model_validate({})
"""Nobody said anything."""
