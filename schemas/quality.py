"""How much of what the sensors should have told was told, and used."""

from pydantic import Field

from schemas.payload import Payload, SessionTime


class SourceQuality(Payload):
    """One sensor or camera since the session started."""

    name: str
    expected: int = Field(ge=0, description="number of samples at the nominal rate, from the first one on")
    used: int = Field(ge=0, description="number of samples that the estimator took")
    rejected: int = Field(ge=0, description="number of samples that came and were refused")
    longest_silence_s: float = Field(ge=0, description="s, longest time without a usable sample")
    misplaced: bool = Field(description="found to be worn otherwise than declared")


class DataQuality(Payload):
    """The session so far, told now and then and at its end; every number counts from the start of the session."""

    captured_ns: SessionTime
    sources: list[SourceQuality]
    calibrated: bool = Field(description="angles refer to a standing that was seen, or to an axis that was found")
    absolute: bool = Field(description="angles carry no unknown constant")
    spanned_s: float = Field(ge=0, description="s since the calibration")
    estimated_s: float = Field(ge=0, description="s of that in which every joint of the model was observed")
    moving_s: float = Field(ge=0, description="s of that in which the person moved")
    locked_s: float = Field(ge=0, description="s of that in which the rhythm was locked")
    late: int = Field(ge=0, description="number of samples that came too late to be used")
