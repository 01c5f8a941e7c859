"""What the API takes and gives for sessions."""

from datetime import datetime
from enum import StrEnum
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from schemas.conditions import Conditions
from schemas.gait import CURVE_POINTS
from schemas.metrics import Doubt, TrustGrade
from schemas.session import WalkPath
from schemas.vocabulary import ESTIMATORS, Misplacement, Side, Task, TaskPhaseKind

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


class ClosedConditions(Conditions):
    """How a test is done. What is not known here is refused, not left out."""

    model_config = ConfigDict(extra="forbid")


def _as_stored(said: Conditions) -> Conditions:
    return Conditions.model_validate(said.model_dump())


ConditionsIn = Annotated[ClosedConditions, AfterValidator(_as_stored)]


class SessionIn(BaseModel):
    """Ask for a session."""

    model_config = ConfigDict(extra="forbid")

    # No slash and no dot: a file of the server can not be named from a browser, only what the server itself offers.
    source: str = Field(
        pattern=r"^((synthetic|device):[a-z_]+(\?[A-Za-z0-9_=&.+-]*)?|[A-Za-z0-9][A-Za-z0-9_-]*)$",
        max_length=300,
        description="an id from GET /v1/sources, a device with options added, or a synthetic person with options",
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
    task: Task | None = Field(
        default=None, description="what the person is asked to do; null for what the source says", examples=["walk"]
    )
    walkway_m: float | None = Field(
        default=None,
        gt=0,
        le=100,
        description="m from start to turning point of a timed up and go; null for what the source says",
        examples=[3.0],
    )
    conditions: ConditionsIn | None = Field(
        default=None, description="how the test is done; null for what the source and the patient's record say"
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
    task: Task | None = Field(description="what the person is asked to do; null before the start", examples=["walk"])
    walkway_m: float | None = Field(description="m from start to turning point of a timed test", examples=[None])
    conditions: Conditions | None = Field(description="how the test is done; null before the start")
    software: str | None = Field(description="what computed the metrics; null before them", examples=["ambula 0.1.0"])
    datum: str | None = Field(
        description="what an angle of zero means; null before the calibration",
        examples=["quiet standing, both segments vertical"],
    )
    misplaced: dict[Side, list[Misplacement]] = Field(
        description="legs whose sensors are worn otherwise than declared", examples=[{"left": ["swapped"]}]
    )
    absolute: bool | None = Field(
        description="whether angles refer to a known posture; if not, each carries an unknown constant offset; null"
        " before the calibration",
        examples=[True],
    )
    lengths: dict[str, float] = Field(
        description="m, of segments as estimated; empty where none is", examples=[{"thigh_left": 0.42}]
    )
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
    unit: str = Field(description="unit of the next five", examples=["m/s"])
    value: float | None = Field(description="in `unit`; null when withheld", examples=[1.12])
    spread: float | None = Field(description="in `unit`: standard deviation over the strides", examples=[0.04])
    mean_std: float | None = Field(description="in `unit`: standard error of the value", examples=[0.01])
    low: float | None = Field(description="in `unit`: lower end of the 95 % interval", examples=[1.09])
    high: float | None = Field(description="in `unit`: upper end of the 95 % interval", examples=[1.15])
    strides: int = Field(ge=0, description="number of strides it rests on", examples=[42])
    grade: TrustGrade = Field(examples=["good"])
    doubts: list[Doubt] = Field(description="what led to the grade, the weightiest first", examples=[[]])
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


class PhaseOut(BaseModel):
    """One phase of a timed test."""

    model_config = ConfigDict(extra="forbid")

    task: Task = Field(examples=["timed_up_and_go"])
    attempt: int = Field(ge=0, description="number of attempts before it in this session", examples=[0])
    phase: TaskPhaseKind = Field(examples=["sit_to_stand"])
    start_s: float = Field(ge=0, description="s of session time", examples=[5.12])
    start_std_s: float = Field(ge=0, description="s, one standard deviation", examples=[0.04])
    end_s: float | None = Field(description="s of session time; null while it runs", examples=[6.87])
    end_std_s: float | None = Field(
        description="s, one standard deviation; null while it runs and when it was given up", examples=[0.05]
    )
    duration_s: float | None = Field(description="s; null while it runs", examples=[1.75])
    duration_std_s: float | None = Field(
        description="s, one standard deviation: those of start and end, taken as independent", examples=[0.06]
    )
    largest_turn_rate: float | None = Field(description="rad/s, of the heading, either way", examples=[1.9])
    largest_thigh_rate: float | None = Field(
        description="rad/s, of the thighs' inclination, in rising or sitting", examples=[2.1]
    )
    steps: int | None = Field(description="number of steps of both legs; null unless both are seen", examples=[None])
    distance_m: float | None = Field(description="m walked in it; null where not measured", examples=[None])
    distance_std_m: float | None = Field(description="m, one standard deviation", examples=[None])


class PhasesOut(BaseModel):
    """All phases of a session's timed tests."""

    model_config = ConfigDict(extra="forbid")

    session: str = Field(description="session id", examples=["8d0c2a71f04be655"])
    final: bool = Field(description="false while the session runs")
    phases: list[PhaseOut] = Field(description="by attempt, in the order in which they are done; the first 500")


class RepetitionOut(BaseModel):
    """One repetition of an exercise: there and back."""

    model_config = ConfigDict(extra="forbid")

    degree_of_freedom: str = Field(description="what is followed", examples=["knee_flexion_left"])
    side: Side | None = Field(description="null for a movement of both sides or of the trunk", examples=["left"])
    index: int = Field(ge=0, description="number of this joint's repetitions before it", examples=[3])
    start_s: float = Field(ge=0, description="s of session time", examples=[12.1])
    turn_s: float = Field(ge=0, description="s of session time: the angle farthest from both ends", examples=[13.3])
    end_s: float = Field(ge=0, description="s of session time", examples=[14.6])
    start_angle: float = Field(description="rad", examples=[0.05])
    turn_angle: float = Field(description="rad", examples=[1.92])
    end_angle: float = Field(description="rad", examples=[0.07])
    angle_std: float = Field(ge=0, description="rad, mean standard deviation of the angle", examples=[0.02])
    largest_velocity: float = Field(ge=0, description="rad/s, either way", examples=[2.4])
    hold_s: float | None = Field(ge=0, description="s at the turn; null where not measured", examples=[0.8])
    ranges: dict[str, float] = Field(
        description="rad, largest minus smallest, of every angle that is seen; empty where one alone is",
        examples=[{"knee_flexion_left": 1.61, "knee_flexion_right": 1.58}],
    )
    valid: bool
    rejected_because: str | None = Field(description="why it does not count in metrics", examples=[None])


class RepetitionsOut(BaseModel):
    """All repetitions of a session."""

    model_config = ConfigDict(extra="forbid")

    session: str = Field(description="session id", examples=["8d0c2a71f04be655"])
    final: bool = Field(description="false while the session runs")
    repetitions: list[RepetitionOut] = Field(description="in order; the first 1000")
