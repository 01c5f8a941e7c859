"""What the API takes and gives for progress. Rules are codes with parameters, listed in services/progress/rules.py."""

from datetime import date, datetime

from pydantic import BaseModel, ConfigDict, Field

from schemas.conditions import SpeedInstruction
from schemas.metrics import TrustGrade
from schemas.population import Population
from schemas.vocabulary import Side, Task
from services.progress.measures import Better
from services.progress.rules import Direction, JointWord, RuleCode, Verdict
from services.progress.thresholds import Occasion


class Shape(BaseModel):
    """Every answer: nothing else in it, nothing left out."""

    model_config = ConfigDict(extra="forbid", from_attributes=True)


class RuleOut(Shape):
    """One rule that applied, with its numbers, so that a page can say it in its language."""

    code: RuleCode = Field(examples=["change_beyond_mdc"])
    parameters: dict[str, float | int | str | None] = Field(
        description="SI; which ones there are follows from the code",
        examples=[{"change": 0.21, "low": 0.18, "high": 0.24, "mdc": 0.15}],
    )


class IntervalOut(Shape):
    """A difference with its 95 % interval."""

    value: float = Field(description="in the unit of the series", examples=[0.21])
    low: float = Field(description="in the unit of the series: lower end of the 95 % interval", examples=[0.18])
    high: float = Field(description="in the unit of the series: upper end of the 95 % interval", examples=[0.24])


class MdcOut(Shape):
    """The minimal detectable change that was frozen with the baseline, and whom it is for."""

    key: str = Field(examples=["lewek_2019_comfortable_speed_middle"])
    value: float = Field(description="in `unit`", examples=[0.15])
    unit: str = Field(examples=["m/s"])
    occasion: Occasion = Field(description="what it compares", examples=["between_days"])
    people: str = Field(description="on whom it was measured", examples=["chronic stroke, n=76"])
    protocol: str = Field(examples=["not stated which start and which timed distance"])
    above: float | None = Field(description="m/s: baseline speeds it is for; null: open", examples=[0.4])
    below: float | None = Field(description="m/s: baseline speeds it is for; null: open", examples=[0.8])
    source: str = Field(examples=["Lewek 2019, S-EPMC6361716"])


class PointOut(Shape):
    """A measure of one session."""

    visit: int = Field(description="number of the visit", examples=[3])
    day: date = Field(examples=["2026-11-22"])
    session: str = Field(description="session id", examples=["8d0c2a71f04be655"])
    value: float | None = Field(description="in the unit of the series; null when withheld", examples=[0.71])
    low: float | None = Field(description="in the unit of the series: lower end of the 95 % interval", examples=[0.69])
    high: float | None = Field(description="in the unit of the series: upper end of the 95 % interval", examples=[0.73])
    grade: TrustGrade = Field(examples=["good"])
    strides: int = Field(description="number of strides it rests on", examples=[42])
    software: str = Field(description="what computed it", examples=["ambula 0.1.0"])
    comparable: bool = Field(description="whether it is like the baseline and to be trusted")
    rules: list[RuleOut] = Field(description="why it is not comparable; empty when it is")


class VisitValueOut(Shape):
    """A measure at one visit: the mean of its comparable trials, and the change since the baseline."""

    visit: int = Field(description="number of the visit", examples=[3])
    day: date = Field(examples=["2026-11-22"])
    sessions: list[str] = Field(description="the trials", examples=[["8d0c2a71f04be655"]])
    value: float = Field(description="in the unit of the series", examples=[0.71])
    low: float = Field(description="in the unit of the series: lower end of the 95 % interval", examples=[0.69])
    high: float = Field(description="in the unit of the series: upper end of the 95 % interval", examples=[0.73])
    change: IntervalOut | None = Field(description="since the baseline; null at the baseline itself")
    verdict: Verdict = Field(examples=["real_change"])
    direction: Direction | None = Field(
        description="of a real change, where the measure has a better side", examples=["better"]
    )
    rules: list[RuleOut] = Field(description="what the verdict comes from")


class RepeatOut(Shape):
    """The last against the first comparable trial of one visit."""

    visit: int = Field(description="number of the visit", examples=[3])
    first: str = Field(description="session id", examples=["8d0c2a71f04be655"])
    last: str = Field(description="session id", examples=["41f7cc02a9d3b810"])
    change: IntervalOut
    mdc: MdcOut | None = Field(description="for trials within one occasion; null: none fits")
    verdict: Verdict = Field(examples=["within_measurement_error"])
    direction: Direction | None = Field(description="of a real change", examples=[None])
    rules: list[RuleOut] = Field(description="what the verdict comes from")


class TrendOut(Shape):
    """Slope over the visits from the baseline on; no verdict rests on it."""

    slope_per_day: float = Field(description="in the unit of the series per day", examples=[0.0021])
    low: float = Field(description="in the unit of the series per day: lower end of the 95 % interval")
    high: float = Field(description="in the unit of the series per day: upper end of the 95 % interval")
    visits: int = Field(description="number of visits it rests on", examples=[6])
    days: float = Field(description="days from the first of them to the last", examples=[70.0])


class SeriesOut(Shape):
    """One measure of one test over the visits."""

    task: Task = Field(examples=["walk"])
    instruction: SpeedInstruction | None = Field(description="tests at another speed are other tests")
    measure: str = Field(examples=["walking_speed"])
    side: str | None = Field(description="left, right, or null for the whole body", examples=[None])
    unit: str = Field(examples=["m/s"])
    better: Better | None = Field(description="which way it gets better; null: not said of everybody")
    points: list[PointOut] = Field(description="every session that has it, in order")
    visits: list[VisitValueOut] = Field(description="from the baseline on, those with a comparable trial")
    baseline: VisitValueOut | None = Field(description="what changes count from")
    mdc: MdcOut | None = Field(description="between days, frozen with the baseline; null: none fits")
    change: IntervalOut | None = Field(description="newest visit with this test against the baseline")
    verdict: Verdict = Field(description="on the newest visit with this test", examples=["real_change"])
    direction: Direction | None = Field(
        description="of a real change, where the measure has a better side", examples=["better"]
    )
    rules: list[RuleOut] = Field(description="what the verdict comes from")
    repeats: list[RepeatOut] = Field(description="trials of one visit against each other")
    trend: TrendOut | None = Field(description="null below three visits")


class JointVisitOut(Shape):
    """Distance of one joint of one leg from the other's over the stride, at one visit."""

    visit: int = Field(description="number of the visit", examples=[3])
    day: date = Field(examples=["2026-11-22"])
    sessions: list[str] = Field(description="the trials", examples=[["8d0c2a71f04be655"]])
    distance: float = Field(description="rad, root mean square", examples=[0.19])
    low: float = Field(description="rad, lower end of the 95 % interval", examples=[0.17])
    high: float = Field(description="rad, upper end of the 95 % interval", examples=[0.21])
    speed: float | None = Field(description="m/s at that visit; null where it is not comparable", examples=[0.71])


class JointRecoveryOut(Shape):
    """Whether a joint recovers or is compensated for while walking gets faster."""

    task: Task = Field(examples=["walk"])
    instruction: SpeedInstruction | None
    joint: str = Field(description="degree of freedom without its side", examples=["knee_flexion"])
    visits: list[JointVisitOut] = Field(description="from the baseline on")
    change: IntervalOut | None = Field(description="rad, of the distance since the baseline")
    word: JointWord = Field(examples=["recovery"])
    rules: list[RuleOut] = Field(description="what the word comes from")


class CurveDistanceOut(Shape):
    """Sagittal curve distance (4 variables); a trend within the patient only, never the GPS."""

    distance: float | None = Field(description="rad, over all four; null where one is missing", examples=[0.09])
    by_variable: dict[str, float] = Field(description="rad, root mean square", examples=[{"knee_flexion": 0.11}])
    missing: list[str] = Field(description="of the four variables", examples=[["ankle_dorsiflexion"]])


class CurveVisitOut(Shape):
    """Curves of one leg at one visit, set against the patient's own."""

    task: Task = Field(examples=["walk"])
    instruction: SpeedInstruction | None
    side: Side = Field(examples=["left"])
    visit: int = Field(description="number of the visit", examples=[3])
    day: date = Field(examples=["2026-11-22"])
    sessions: list[str] = Field(description="the trials", examples=[["8d0c2a71f04be655"]])
    from_baseline: CurveDistanceOut | None = Field(description="null at the baseline itself")
    from_other_leg: CurveDistanceOut = Field(description="of the leg's own joints, so never of all four variables")


class ProgressOut(Shape):
    """All that is said of a patient's progress."""

    patient: str = Field(description="patient code", examples=["K7QM3F"])
    series: list[SeriesOut] = Field(description="by test; within it, speed first")
    joint_recovery: list[JointRecoveryOut] = Field(description="empty where one leg is seen")
    curve_distance: list[CurveVisitOut] = Field(description="by visit and leg, from the baseline on")


class BaselineIn(BaseModel):
    """Choose what progress counts from."""

    model_config = ConfigDict(extra="forbid")

    session: str = Field(
        pattern="^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$",
        description="a session of the visit that is to be the baseline",
        examples=["8d0c2a71f04be655"],
    )


class TestBaselineOut(Shape):
    """What one test at one speed counts from."""

    __test__ = False

    task: Task = Field(examples=["walk"])
    instruction: SpeedInstruction | None = Field(examples=["comfortable"])
    visit: int = Field(description="number of the visit", examples=[1])
    day: date = Field(examples=["2026-09-13"])
    sessions: list[str] = Field(description="trials that are alike", examples=[["8d0c2a71f04be655"]])
    speed: float | None = Field(description="m/s: comfortable speed then, which chose the band", examples=[0.52])
    thresholds: dict[str, list[MdcOut]] = Field(description="by measure; those that fit, frozen")


class BaselineOut(Shape):
    """What a patient's progress counts from."""

    patient: str = Field(description="patient code", examples=["K7QM3F"])
    session: str = Field(description="session id", examples=["8d0c2a71f04be655"])
    visit: int = Field(description="number of its visit", examples=[1])
    day: date = Field(examples=["2026-09-13"])
    frozen: datetime = Field(description="UTC", examples=["2026-09-13T10:02:11Z"])
    chosen: bool = Field(description="by somebody; else it is the first usable visit")
    population: Population | None = Field(description="whose thresholds were taken; null: was not known")
    table: str = Field(description="version of the table of thresholds", examples=["2026-11"])
    references: dict[str, str] = Field(description="version of each reference set then")
    tests: list[TestBaselineOut]
