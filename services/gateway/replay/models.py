"""What the API gives of a session that is over, moment by moment."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from schemas.vocabulary import CameraKind, GaitEventKind, JointCentre, Segment, SensorState, Side, Task
from services.gateway.sessions.models import PhaseOut

Vector = Annotated[list[float], Field(min_length=3, max_length=3)]
Quaternion = Annotated[list[float], Field(min_length=4, max_length=4)]
Session = Annotated[str, Field(description="session id", examples=["8d0c2a71f04be655"])]
Next = Annotated[
    float | None, Field(description="s, `from_s` of the next page; null at the end of the session", examples=[10.0])
]


class WornOut(BaseModel):
    """An inertial sensor of the session."""

    model_config = ConfigDict(extra="forbid")

    name: str = Field(examples=["shank_left"])
    segment: Segment
    rate_hz: float = Field(gt=0, description="nominal sample rate, Hz")


class WatchingOut(BaseModel):
    """A camera of the session."""

    model_config = ConfigDict(extra="forbid")

    name: str = Field(examples=["kinect"])
    kind: CameraKind
    rate_hz: float = Field(gt=0, description="nominal frame rate, Hz")
    floor_m: float | None = Field(description="m, height of the floor, negative below the camera; null: not known")


class BodyOut(BaseModel):
    """Lengths that the figure is drawn with."""

    model_config = ConfigDict(extra="forbid")

    thigh_length_m: float = Field(gt=0, description="m, hip centre to knee centre")
    shank_length_m: float = Field(gt=0, description="m, knee centre to ankle centre")
    hip_width_m: float = Field(gt=0, description="m, between the hip centres")


class RecordedOut(BaseModel):
    """What the recording of a session says of how it was made."""

    model_config = ConfigDict(extra="forbid")

    session: Session
    task: Task
    walkway_m: float | None = Field(description="m from start to turning point of a timed test; else null")
    estimator: str = Field(examples=["rhythmic_ekf"])
    sensors: list[WornOut]
    cameras: list[WatchingOut]
    body: BodyOut
    end_s: float = Field(ge=0, description="s of session time of the newest recorded message", examples=[60.0])


class BoneOut(BaseModel):
    """Where a segment is drawn."""

    model_config = ConfigDict(extra="forbid")

    position: Vector = Field(description="m, proximal joint in the world, pelvis at the origin of x and z")
    quat_world_from_segment: Quaternion = Field(description="rotation (w, x, y, z), dimensionless")
    valid: bool = Field(description="false while no sensor tells it")


class SensorStateOut(BaseModel):
    """A sensor at one instant."""

    model_config = ConfigDict(extra="forbid")

    sensor: str = Field(examples=["shank_left"])
    state: SensorState = Field(examples=["ok"])
    since_s: float = Field(ge=0, description="s of session time, of its newest sample that was new")


class CameraStateOut(BaseModel):
    """A camera at one instant."""

    model_config = ConfigDict(extra="forbid")

    camera: str = Field(examples=["kinect"])
    state: SensorState = Field(examples=["ok"])
    people: int = Field(ge=0, description="number of people followed; 0 while nobody was in view")
    since_s: float = Field(ge=0, description="s of session time, of its newest picture")


class AnglesOut(BaseModel):
    """Angles at one instant."""

    model_config = ConfigDict(extra="forbid")

    at_s: float = Field(ge=0, description="s of session time")
    angles: dict[str, float] = Field(description="rad, by degree of freedom; only valid ones")
    angles_std: dict[str, float] = Field(description="rad, by degree of freedom; only valid ones")


class PoseOut(AnglesOut):
    """A picture as a live page gets it; what the estimator advised at the time is not recorded, so texts are empty."""

    kind: Literal["pose"]
    age_s: float = Field(ge=0, description="s; 0 in a replay")
    phase: str = Field(description="waiting, calibrating or estimating", examples=["estimating"])
    message: str = Field(description="empty in a replay")
    notice: str = Field(description="empty in a replay")
    segments: dict[Segment, BoneOut]
    trail: list[AnglesOut] = Field(description="angles between two pictures; empty in a replay")
    sensors: list[SensorStateOut]
    centres: dict[JointCentre, Vector] = Field(description="m, in the axes of the camera's room; empty without camera")
    cameras: list[CameraStateOut]
    cadence_per_min: float | None = Field(description="steps per minute while the rhythm is locked")
    stood: float | None = Field(description="share, dimensionless; null in a replay")


class PosesOut(BaseModel):
    """Pictures of a stretch of a session."""

    model_config = ConfigDict(extra="forbid")

    session: Session
    from_s: float = Field(ge=0, description="s of session time, included")
    to_s: float = Field(gt=0, description="s of session time, not included")
    end_s: float = Field(ge=0, description="s of session time of the newest recorded message")
    next_s: Next
    poses: list[PoseOut] = Field(description="in the order of time, at most `rate_hz` a second")


class StrideOut(BaseModel):
    """One stride: from a contact to the next one of the same foot."""

    model_config = ConfigDict(extra="forbid")

    side: Side = Field(examples=["left"])
    index: int = Field(ge=0, description="number of this side's strides before it", examples=[3])
    start_s: float = Field(ge=0, description="s of session time, initial contact", examples=[12.1])
    toe_off_s: float | None = Field(description="s of session time; null when not seen", examples=[12.8])
    end_s: float = Field(ge=0, description="s of session time, next contact of that foot", examples=[13.2])
    stride_time_s: float = Field(gt=0, description="s", examples=[1.1])
    stance_fraction: float | None = Field(description="stance time / stride time, dimensionless", examples=[0.63])
    step_time_s: float | None = Field(description="s; null when not known", examples=[0.55])
    step_length_m: float | None = Field(description="m; null when not known", examples=[0.61])
    step_length_std_m: float | None = Field(description="m, one standard deviation; 1.96 of it is the 95 % interval")
    stride_length_m: float | None = Field(description="m; null when not known", examples=[1.22])
    walking_speed: float | None = Field(description="m/s, stride length / stride time", examples=[1.1])
    step_width_m: float | None = Field(description="m; from a camera only", examples=[None])
    circumduction_m: float | None = Field(description="m, how far the ankle swings outward", examples=[0.02])
    turn: float | None = Field(description="rad, of the pelvis within the stride, to the left positive")
    turning: bool = Field(description="the pelvis turned by more than the limit")
    valid: bool = Field(description="it counts in the session's numbers")
    rejected_because: str | None = Field(description="why it does not count", examples=[None])


class StridePage(BaseModel):
    """Some strides of a session, in the order in which they ended."""

    model_config = ConfigDict(extra="forbid")

    session: Session
    total: int = Field(ge=0, description="number of all strides")
    items: list[StrideOut]


class ContactOut(BaseModel):
    """A foot meets or leaves the floor."""

    model_config = ConfigDict(extra="forbid")

    event: GaitEventKind
    side: Side
    at_s: float = Field(ge=0, description="s of session time", examples=[12.1])
    time_std_s: float = Field(ge=0, description="s, one standard deviation", examples=[0.01])


class MarkedOut(BaseModel):
    """The operator said that the person stood still."""

    model_config = ConfigDict(extra="forbid")

    from_s: float = Field(ge=0, description="s of session time")
    to_s: float = Field(ge=0, description="s of session time")
    given_s: float = Field(ge=0, description="s of session time when it was said")


class LossOut(BaseModel):
    """A sensor or a camera told nothing."""

    model_config = ConfigDict(extra="forbid")

    source: str = Field(description="name of the sensor or camera", examples=["shank_left"])
    kind: Literal["missing", "stuck", "nobody"] = Field(
        description="nothing came; the same values came again and again; the camera saw no person"
    )
    start_s: float = Field(ge=0, description="s of session time of its last new sample", examples=[31.4])
    end_s: float | None = Field(description="s of session time of the next one; null: none until `to_s`")


class EventsOut(BaseModel):
    """What happened in a stretch of a session."""

    model_config = ConfigDict(extra="forbid")

    session: Session
    from_s: float = Field(ge=0, description="s of session time, included")
    to_s: float = Field(gt=0, description="s of session time, not included")
    end_s: float = Field(ge=0, description="s of session time of the newest recorded message")
    next_s: Next
    contacts: list[ContactOut]
    phases: list[PhaseOut] = Field(description="parts of timed tests that go on in it")
    marks: list[MarkedOut] = Field(description="given in it")
    losses: list[LossOut] = Field(description="that go on in it")
