"""The band that a person's value is set against, or why there is none. Never a band of other people."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from schemas.population import Population, Sex
from services.reference.sets import ReferenceSet, SetKind, Stratum

Z90 = 1.644854
"""Standard deviations from the mean to the 5th and 95th percentile of a normal distribution."""


class NoBand(StrEnum):
    """Why there is no band, the nearest to one first."""

    MEAN_ONLY = "mean_only"
    SPEED_UNKNOWN = "speed_unknown"
    SPEED_OUTSIDE = "speed_outside"
    SEX_UNKNOWN = "sex_unknown"
    SEX_OUTSIDE = "sex_outside"
    AGE_UNKNOWN = "age_unknown"
    AGE_OUTSIDE = "age_outside"
    DATUM_DIFFERS = "datum_differs"
    UNIT_DIFFERS = "unit_differs"
    NOT_IN_ANY_SET = "not_in_any_set"


class Extent(StrEnum):
    """What the ends of a band are."""

    PERCENTILES = "percentiles_5_95"
    NORMAL = "normal_5_95"
    """mean -+ 1.645 SD: 5th and 95th percentile of a normal distribution with the published mean and SD."""


class Position(StrEnum):
    """Of a value; never normal or abnormal."""

    BELOW = "below"
    WITHIN = "within"
    ABOVE = "above"


@dataclass(frozen=True, slots=True)
class Person:
    """Who is compared. Age in years, comfortable or walked speed in m/s; null: not known."""

    age: float | None
    sex: Sex | None
    speed: float | None


@dataclass(frozen=True, slots=True)
class Band:
    """What to draw and print, in `unit`."""

    measure: str
    unit: str
    low: float
    high: float
    extent: Extent
    mean: float | None
    sd: float | None
    n: int | None
    """People in the stratum; null: not stated."""
    sex: Sex | None
    from_age: float | None
    to_age: float | None
    from_speed: float | None
    to_speed: float | None
    speed_matched: bool
    set_name: str
    set_version: str
    title: str
    citation: str
    licence: str
    population: Population


def band(
    sets: Iterable[ReferenceSet], measure: str, unit: str, person: Person, datum: str | None = None
) -> Band | NoBand:
    """The band of the first set, in the order given, with a stratum that fits; of several in it, one matched by speed.

    `datum` is that of the person's own angles; one of another datum is refused.
    """
    nearest = NoBand.NOT_IN_ANY_SET
    for one in sets:
        if one.manifest.kind is not SetKind.NORMS:
            continue
        strata = [stratum for stratum in one.strata if stratum.measure == measure]
        for stratum in sorted(strata, key=lambda each: each.from_speed is None):
            why = _why_not(one, stratum, unit, person, datum)
            if why is None:
                return _band(one, stratum, person)
            nearest = min(nearest, why, key=list(NoBand).index)
    return nearest


def position(value: float, band: Band) -> Position:
    """Where a value lies."""
    if value < band.low:
        return Position.BELOW
    return Position.ABOVE if value > band.high else Position.WITHIN


def _why_not(one: ReferenceSet, stratum: Stratum, unit: str, person: Person, datum: str | None) -> NoBand | None:
    """The first thing in which a stratum does not fit; what is checked last fits best."""
    if stratum.unit != unit:
        return NoBand.UNIT_DIFFERS
    if unit == "rad" and one.manifest.datum != datum:
        return NoBand.DATUM_DIFFERS
    if stratum.from_age is not None or stratum.to_age is not None:
        if person.age is None:
            return NoBand.AGE_UNKNOWN
        if not _within(person.age, stratum.from_age, stratum.to_age):
            return NoBand.AGE_OUTSIDE
    if stratum.sex is not None and stratum.sex is not person.sex:
        return NoBand.SEX_UNKNOWN if person.sex is None else NoBand.SEX_OUTSIDE
    if stratum.from_speed is not None or stratum.to_speed is not None:
        if person.speed is None:
            return NoBand.SPEED_UNKNOWN
        if not _within(person.speed, stratum.from_speed, stratum.to_speed):
            return NoBand.SPEED_OUTSIDE
    if stratum.sd is None and (stratum.low is None or stratum.high is None):
        return NoBand.MEAN_ONLY
    return None


def _within(value: float, low: float | None, high: float | None) -> bool:
    return (low is None or value >= low) and (high is None or value <= high)


def _band(one: ReferenceSet, stratum: Stratum, person: Person) -> Band:
    mean = stratum.mean
    if mean is not None and stratum.per_speed is not None:
        assert person.speed is not None
        assert stratum.at_speed is not None
        mean += stratum.per_speed * (person.speed - stratum.at_speed)
    if stratum.low is not None and stratum.high is not None:
        low, high, extent = stratum.low, stratum.high, Extent.PERCENTILES
    else:
        assert mean is not None
        assert stratum.sd is not None
        low, high, extent = mean - Z90 * stratum.sd, mean + Z90 * stratum.sd, Extent.NORMAL
    return Band(
        measure=stratum.measure,
        unit=stratum.unit,
        low=low,
        high=high,
        extent=extent,
        mean=mean,
        sd=stratum.sd,
        n=stratum.n,
        sex=stratum.sex,
        from_age=stratum.from_age,
        to_age=stratum.to_age,
        from_speed=stratum.from_speed,
        to_speed=stratum.to_speed,
        speed_matched=stratum.from_speed is not None or stratum.to_speed is not None,
        set_name=one.manifest.name,
        set_version=one.manifest.version,
        title=one.manifest.title,
        citation=one.manifest.citation,
        licence=one.manifest.licence,
        population=one.manifest.population,
    )
