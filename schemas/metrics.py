"""What a session amounts to so far: numbers with their spread, and mean curves."""

from enum import StrEnum
from typing import Any

from pydantic import Field, model_validator

from schemas.gait import CURVE_POINTS
from schemas.payload import Payload, SessionTime
from schemas.quality import DataQuality
from schemas.tasks import Repetition, TaskPhase
from schemas.vocabulary import Side


class TrustGrade(StrEnum):
    """How far a number may be relied on."""

    GOOD = "good"
    FAIR = "fair"
    POOR = "poor"
    WITHHELD = "withheld"


class DoubtKind(StrEnum):
    """What speaks against a number."""

    FEW_CYCLES = "few_cycles"
    NOT_OBSERVED = "not_observed"
    COVERAGE = "coverage"
    REJECTED_CYCLES = "rejected_cycles"
    LOSS = "loss"
    SILENCE = "silence"
    LATE = "late"
    MISPLACED = "misplaced"
    NOT_CALIBRATED = "not_calibrated"
    NOT_ABSOLUTE = "not_absolute"
    NOT_LOCKED = "not_locked"
    WARM_UP = "warm_up"
    WIDE_INTERVAL = "wide_interval"
    WEAK_MEASURE = "weak_measure"
    IMPLAUSIBLE = "implausible"
    NOT_POSITIVE = "not_positive"
    CONDITIONS_UNSAID = "conditions_unsaid"


class Doubt(Payload):
    """One reason for less than full trust, so that a screen can say it in its language."""

    kind: DoubtKind
    value: float | None = Field(description="what was found: a share, a count or s, as the kind implies")
    limit: float | None = Field(description="what would have been needed, same unit")
    subject: str | None = Field(description="sensor, joint or side it is about")


class Metric(Payload):
    """One number of a session or of one side."""

    name: str
    side: str | None = Field(description="left, right, or null for the whole body")
    unit: str = Field(description="unit of value, mean_std and spread")
    value: float | None = Field(description="in `unit`; null when it was withheld")
    spread: float | None = Field(description="in `unit`: standard deviation over the strides")
    mean_std: float | None = Field(description="in `unit`: standard error of the value")
    low: float | None = Field(description="in `unit`: lower end of the 95 % interval of the value; null: not known")
    high: float | None = Field(description="in `unit`: upper end of the 95 % interval of the value; null: not known")
    strides: int = Field(ge=0, description="number of strides it rests on")
    grade: TrustGrade
    doubts: list[Doubt] = Field(description="what led to the grade, the weightiest first; empty when nothing did")
    withheld_because: str | None

    @model_validator(mode="before")
    @classmethod
    def _of_an_older_writer(cls, fields: Any) -> Any:
        """Earlier ones gave no interval and no grade; what nobody has judged is no better than fair."""
        if not isinstance(fields, dict):
            return fields
        grade = TrustGrade.FAIR if fields.get("value") is not None else TrustGrade.WITHHELD
        return {"low": None, "high": None, "grade": grade, "doubts": [], **fields}


class MeanCurve(Payload):
    """Mean and spread of one joint over 0-100 % of the stride."""

    degree_of_freedom: str
    strides: int = Field(ge=0, description="number of strides it rests on")
    mean: list[float] = Field(min_length=CURVE_POINTS, max_length=CURVE_POINTS, description="rad at 0 ... 100 %")
    spread: list[float] = Field(min_length=CURVE_POINTS, max_length=CURVE_POINTS, description="rad at 0 ... 100 %")


class SideComparison(Payload):
    """One joint of one leg against the same joint of the other, over the stride."""

    joint: str = Field(description="degree of freedom without its side, e.g. knee_flexion")
    reference_side: Side = Field(description="the non-paretic side where one is declared, else right")
    rmse: float = Field(ge=0, description="rad, root mean square difference after alignment by phase, levels kept")
    rmse_std: float = Field(ge=0, description="rad, what the scatter of the strides alone would give")
    rmse_about_mean: float = Field(ge=0, description="rad, the same with each curve about its mean")
    shift: float = Field(description="share of a stride by which the other leg was moved beyond half a stride")
    strides: int = Field(ge=0, description="number of strides of the side with fewer")


class SessionMetrics(Payload):
    """All metrics of a session up to `captured_ns`; the last one of a session is final."""

    captured_ns: SessionTime
    final: bool
    software: str = Field(description="what computed it: name, version and digest of the code")
    metrics: list[Metric]
    curves: list[MeanCurve]
    sides: list[SideComparison] = Field(description="leg against leg, joint by joint; empty where one leg is seen")
    quality: DataQuality | None = Field(description="null where estimation told nothing of it")
    phases: list[TaskPhase] = Field(max_length=500, description="of timed tests so far, in order; the first 500")
    repetitions: list[Repetition] = Field(max_length=1000, description="in order, when final; the first 1000")

    @model_validator(mode="before")
    @classmethod
    def _of_an_older_writer(cls, fields: Any) -> Any:
        """Earlier ones knew of walking only, then nothing of the data's quality nor of who computed them."""
        later: dict[str, Any] = {
            "phases": [],
            "repetitions": [],
            "software": "ambula 0.1.0",
            "sides": [],
            "quality": None,
        }
        return {**later, **fields} if isinstance(fields, dict) else fields
