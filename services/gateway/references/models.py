"""What the API gives for reference sets."""

from pydantic import Field

from schemas.population import Population, Sex
from services.gateway.progress.models import Shape
from services.reference.bands import Extent, NoBand, Position
from services.reference.sets import SetKind


class StratumOut(Shape):
    """One row of a set: whom it is for, and what they have. Null bounds are open."""

    measure: str = Field(examples=["walking_speed"])
    unit: str = Field(examples=["m/s"])
    sex: Sex | None = Field(description="null: both", examples=["male"])
    from_age: float | None = Field(description="years", examples=[41.0])
    to_age: float | None = Field(description="years", examples=[50.999])
    from_speed: float | None = Field(description="m/s", examples=[None])
    to_speed: float | None = Field(description="m/s", examples=[None])
    n: int | None = Field(description="number of people; null: not stated", examples=[None])
    mean: float | None = Field(description="in `unit`", examples=[1.41])
    sd: float | None = Field(description="in `unit`: standard deviation over people", examples=[0.21])
    low: float | None = Field(description="in `unit`: 5th percentile, or limit of a plausibility set", examples=[None])
    high: float | None = Field(description="in `unit`: 95th percentile, or limit of a plausibility set")
    at_speed: float | None = Field(description="m/s at which the mean holds, of a line over speed", examples=[None])
    per_speed: float | None = Field(description="in `unit` per m/s: slope of that line", examples=[None])


class ReferenceSetOut(Shape):
    """One reference set with all that has to be printed beside it."""

    name: str = Field(examples=["mobbs_2025"])
    title: str = Field(examples=["Walking speed of healthy men"])
    version: str = Field(examples=["1"])
    kind: SetKind = Field(description="norms give bands; plausibility limits never do", examples=["norms"])
    licence: str = Field(examples=["CC BY"])
    citation: str = Field(examples=["Mobbs 2025, Sensors 25(2):581"])
    population: Population = Field(examples=["healthy"])
    n: int | None = Field(description="number of people; null: not stated", examples=[43])
    ages: str = Field(examples=["men 31-40 and 41-50 years"])
    sensor: str = Field(examples=["lower-back sensor"])
    datum: str | None = Field(description="what an angle of zero means; null: the set has no angles", examples=[None])
    notes: str = Field(examples=["Mean and standard deviation."])
    own: bool = Field(description="added by the clinic")
    strata: list[StratumOut]
    curves: list[str] = Field(description="degrees of freedom with a mean curve", examples=[[]])


class RefusedSetOut(Shape):
    """A folder that is no reference set, and why."""

    folder: str = Field(examples=["our_clinic"])
    where: str = Field(examples=["table.csv: line 3"])
    what: str = Field(examples=["unit is 'cm'; it is one of m, s, m/s, rad, 1, steps/min"])


class ReferencePage(Shape):
    """Part of the list: the clinic's own first."""

    total: int = Field(ge=0, description="number of all sets", examples=[4])
    items: list[ReferenceSetOut]
    refused: list[RefusedSetOut] = Field(description="folders that could not be taken, all of them")


class BandOut(Shape):
    """5th to 95th percentile of people like this one."""

    low: float = Field(description="in the metric's unit", examples=[1.06])
    high: float = Field(description="in the metric's unit", examples=[1.76])
    extent: Extent = Field(description="as published, or from mean and SD of a normal distribution")
    mean: float | None = Field(description="in the metric's unit", examples=[1.41])
    sd: float | None = Field(description="in the metric's unit", examples=[0.21])
    n: int | None = Field(description="number of people; null: not stated", examples=[None])
    sex: Sex | None = Field(description="null: both", examples=["male"])
    from_age: float | None = Field(description="years", examples=[41.0])
    to_age: float | None = Field(description="years", examples=[50.999])
    from_speed: float | None = Field(description="m/s", examples=[None])
    to_speed: float | None = Field(description="m/s", examples=[None])
    speed_matched: bool
    set_name: str = Field(examples=["mobbs_2025"])
    set_version: str = Field(examples=["1"])
    title: str = Field(examples=["Walking speed of healthy men"])
    citation: str = Field(examples=["Mobbs 2025, Sensors 25(2):581"])
    licence: str = Field(examples=["CC BY"])
    population: Population = Field(examples=["healthy"])


class MetricReferenceOut(Shape):
    """One metric of a session against reference."""

    measure: str = Field(examples=["walking_speed"])
    side: str | None = Field(examples=[None])
    unit: str = Field(examples=["m/s"])
    band: BandOut | None = Field(description="null where none fits")
    position: Position | None = Field(description="against the band; null without one or without a value")
    because: NoBand | None = Field(description="why there is no band", examples=["age_unknown"])


class SessionReferencesOut(Shape):
    """Every metric of a session against reference."""

    session: str = Field(description="session id", examples=["8d0c2a71f04be655"])
    age: int | None = Field(description="years, in the year of the session", examples=[69])
    sex: Sex | None
    speed: float | None = Field(description="m/s, as walked in the session", examples=[1.12])
    metrics: list[MetricReferenceOut]
