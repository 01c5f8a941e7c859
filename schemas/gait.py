"""Gait events and strides."""

from typing import Any

from pydantic import Field, model_validator

from schemas.payload import Payload, SessionTime
from schemas.vocabulary import GaitEventKind, Side

CURVE_POINTS = 101
"""Samples of a curve over one stride, 0 to 100 % inclusive."""


class GaitEvent(Payload):
    """One contact event."""

    kind: GaitEventKind
    side: Side
    captured_ns: SessionTime
    time_std_s: float = Field(ge=0, description="s, one standard deviation of the event's time")


class StrideCurve(Payload):
    """One joint over one stride."""

    position: list[float] = Field(
        min_length=CURVE_POINTS, max_length=CURVE_POINTS, description="rad at 0, 1, ... 100 % of the stride"
    )
    position_std: float = Field(ge=0, description="rad, mean standard deviation over the stride")


class Stride(Payload):
    """From one initial contact to the next of the same foot."""

    side: Side
    index: int = Field(ge=0, description="count of this side's strides since the session started")
    start_ns: SessionTime
    toe_off_ns: SessionTime | None
    opposite_contact_ns: SessionTime | None = Field(description="initial contact of the other foot within the stride")
    opposite_toe_off_ns: SessionTime | None = Field(
        description="toe-off of the other foot within the stride: the end of the first double support"
    )
    end_ns: SessionTime
    stride_time_s: float = Field(gt=0, description="s")
    stance_fraction: float | None = Field(ge=0, le=1, description="stance time / stride time, dimensionless")
    step_time_s: float | None = Field(description="s, contact of the other foot to this foot's contact at the end")
    step_length_m: float | None = Field(
        description="m, forward distance from the other foot to this foot at the contact that ends the stride"
    )
    step_length_std_m: float | None = Field(description="m, one standard deviation")
    stride_length_m: float | None = Field(description="m, this step plus the other foot's step within the stride")
    walking_speed: float | None = Field(description="m/s, stride length / stride time")
    step_width_m: float | None = Field(
        description="m, sideways distance of the feet at the contact that ends the stride; from a camera only"
    )
    circumduction_m: float | None = Field(
        description="m, how far the ankle swings outward of the straight line between its two contacts"
    )
    turn: float | None = Field(description="rad, by how much the pelvis turned within the stride, to the left positive")
    phase_advance: float | None = Field(description="rad of rhythm phase over the stride; null when unlocked")
    turning: bool = Field(description="the pelvis turned by more than the limit within the stride")
    valid: bool
    rejected_because: str | None = Field(description="why a stride does not count in metrics")
    curves: dict[str, StrideCurve] = Field(description="by degree of freedom; only valid ones")

    @model_validator(mode="before")
    @classmethod
    def _of_an_older_writer(cls, fields: Any) -> Any:
        """Earlier ones told less of the other foot and of the sides."""
        later = {"opposite_toe_off_ns": None, "step_width_m": None, "circumduction_m": None, "turn": None}
        return {**later, **fields} if isinstance(fields, dict) else fields
