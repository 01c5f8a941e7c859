"""What the API takes and gives for sessions."""

from datetime import datetime
from enum import StrEnum
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from schemas.gait import CURVE_POINTS
from schemas.session import WalkPath
from schemas.vocabulary import ESTIMATORS

Code = Annotated[str, Field(pattern="^[0-9A-Z]{1,16}$", description="patient code", examples=["K7QM3F"])]


def _known_estimator(name: str) -> str:
    if name not in ESTIMATORS:
        raise ValueError(f"unknown estimator; choose one of {', '.join(ESTIMATORS)}")
    return name


EstimatorName = Annotated[str, AfterValidator(_known_estimator), Field(json_schema_extra={"enum": [*ESTIMATORS]})]


class SessionState(StrEnum):
    """Where a session is in its life."""

    CREATED = "created"
    LIVE = "live"
    FINISHED = "finished"
    INTERRUPTED = "interrupted"
    FAILED = "failed"


class SessionIn(BaseModel):
    """Ask for a session."""

    model_config = ConfigDict(extra="forbid")

    # No slash and no dot: a file of the server can not be named from a browser, only what the server itself offers.
    source: str = Field(
        pattern=r"^(synthetic:[a-z_]+(\?[A-Za-z0-9_=&.+-]*)?|[A-Za-z0-9][A-Za-z0-9_-]*)$",
        max_length=300,
        description="an id from GET /v1/sources, or a synthetic walker with its options",
        examples=["synthetic:walk?speed=1.1&seed=3&duration=60"],
    )
    speed: float | None = Field(
        default=1.0, gt=0, le=100, description="times real time; null for as fast as possible", examples=[1.0]
    )
    estimator: EstimatorName | None = Field(default=None, description="null for the default", examples=["rhythmic_ekf"])
    walk_path: WalkPath | None = Field(
        default=None,
        description="straight: treadmill, in place, or a corridor without a turn; turning: anywhere; null for what"
        " the source says, else turning",
        examples=["turning"],
    )
    patient: Code | None = Field(default=None, description="patient code; null to link it later")


class MarkIn(BaseModel):
    """The person stands still now, and has for some seconds."""

    model_config = ConfigDict(extra="forbid")

    last_s: float = Field(default=3.0, ge=1, le=10, description="s of standing", examples=[3.0])
    at_s: float | None = Field(
        default=None, ge=0, le=1e7, description="s: session time on the screen; null for the newest", examples=[12.4]
    )


class MarkOut(BaseModel):
    """A mark on its way. Whether it is taken for standing is said by `notice` in the live stream."""

    model_config = ConfigDict(extra="forbid")

    session: str = Field(description="session id", examples=["8d0c2a71f04be655"])
    from_s: float = Field(ge=0, description="s of session time", examples=[9.4])
    to_s: float = Field(ge=0, description="s of session time", examples=[12.4])


class SessionLink(BaseModel):
    """To whom a session belongs."""

    model_config = ConfigDict(extra="forbid")

    patient: Code | None = Field(description="patient code; null to take the link away")


class Highlights(BaseModel):
    """The numbers that a list shows; null where metrics withheld them."""

    model_config = ConfigDict(extra="forbid")

    walking_speed: float | None = Field(description="m/s", examples=[1.12])
    cadence_per_min: float | None = Field(description="steps per minute", examples=[108.4])
    strides: int = Field(ge=0, description="number of strides used", examples=[42])


class SessionOut(BaseModel):
    """A session as the database has it."""

    model_config = ConfigDict(extra="forbid")

    id: str = Field(description="random id", examples=["8d0c2a71f04be655"])
    title: str = Field(examples=["Synthetic walk, 1.1 m/s"])
    patient: str | None = Field(description="patient code; null while unassigned", examples=["K7QM3F"])
    protocol: str = Field(examples=["walk"])
    state: SessionState = Field(examples=["live"])
    reason: str | None = Field(description="why it failed or was interrupted", examples=[None])
    created: datetime = Field(description="UTC", examples=["2026-11-22T09:30:00Z"])
    started: datetime | None = Field(description="UTC", examples=["2026-11-22T09:30:01Z"])
    ended: datetime | None = Field(description="UTC", examples=[None])
    duration_s: float | None = Field(
        description="s: length of a finished session, expected length of a live one", examples=[60.0]
    )
    estimator: str = Field(examples=["rhythmic_ekf"])
    origin: str = Field(description="recording, archive, synthetic or device", examples=["synthetic"])
    source: str | None = Field(description="as asked for; null when it started by itself", examples=["synthetic:walk"])
    highlights: Highlights | None = Field(description="null before the first metrics")


class SessionPage(BaseModel):
    """Part of the list, newest first."""

    model_config = ConfigDict(extra="forbid")

    total: int = Field(ge=0, description="number of sessions that match", examples=[1])
    items: list[SessionOut]


class MetricOut(BaseModel):
    """One number of a session."""

    model_config = ConfigDict(extra="forbid")

    name: str = Field(examples=["walking_speed"])
    side: Literal["left", "right"] | None = Field(description="null for the whole body", examples=[None])
    unit: str = Field(description="unit of the next three", examples=["m/s"])
    value: float | None = Field(description="in `unit`; null when withheld", examples=[1.12])
    spread: float | None = Field(description="in `unit`: standard deviation over the strides", examples=[0.04])
    mean_std: float | None = Field(description="in `unit`: standard error of the value", examples=[0.01])
    strides: int = Field(ge=0, description="number of strides it rests on", examples=[42])
    withheld_because: str | None = Field(description="why there is no value", examples=[None])


class MetricsOut(BaseModel):
    """All metrics of a session."""

    model_config = ConfigDict(extra="forbid")

    session: str = Field(description="session id", examples=["8d0c2a71f04be655"])
    final: bool = Field(description="false while the session runs")
    at_s: float = Field(ge=0, description="s of session time they cover", examples=[60.0])
    metrics: list[MetricOut]


Curve = Annotated[list[float], Field(min_length=CURVE_POINTS, max_length=CURVE_POINTS)]


class CurveOut(BaseModel):
    """Mean and spread of one joint over the stride."""

    model_config = ConfigDict(extra="forbid")

    degree_of_freedom: str = Field(examples=["knee_flexion_left"])
    strides: int = Field(ge=0, description="number of strides it rests on", examples=[21])
    mean: Curve = Field(description="rad at 0, 1, ... 100 % of the stride, initial contact to initial contact")
    spread: Curve = Field(description="rad, standard deviation over the strides")


class CurvesOut(BaseModel):
    """All mean curves of a session."""

    model_config = ConfigDict(extra="forbid")

    session: str = Field(description="session id", examples=["8d0c2a71f04be655"])
    final: bool = Field(description="false while the session runs")
    curves: list[CurveOut]
