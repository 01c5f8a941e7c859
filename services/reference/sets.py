"""A reference set as plain values: manifest, strata of its table, mean curves."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from pydantic import ConfigDict, Field

from schemas.payload import Payload
from schemas.population import Population, Sex


class SetKind(StrEnum):
    """What a set may be used for."""

    NORMS = "norms"
    PLAUSIBILITY = "plausibility"
    """Limits beyond which a value is doubted; no norms, so never a band."""


class Manifest(Payload):
    """`manifest.toml`: all that a screen prints of a set. What TOML cannot say, null, is said by leaving it out."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False, extra="forbid")

    name: str = Field(pattern="^[a-z0-9_]{1,64}$", description="as the folder")
    title: str = Field(min_length=1, max_length=200)
    version: str = Field(min_length=1, max_length=32)
    kind: SetKind
    licence: str = Field(min_length=1, max_length=200)
    citation: str = Field(min_length=1, max_length=500)
    population: Population
    n: int | None = Field(default=None, gt=0, description="people in the set; null: not stated in the source read")
    ages: str = Field(min_length=1, max_length=200, description="who they were, in the source's words")
    sensor: str = Field(min_length=1, max_length=200, description="what it was measured with")
    datum: str | None = Field(
        default=None, max_length=200, description="what an angle of zero means; null: the set has no angles"
    )
    notes: str = Field(max_length=1000)


@dataclass(frozen=True, slots=True)
class Stratum:
    """One row of `table.csv`. Null bounds are open; `sex` null: both. All in `unit`.

    mean of a person who walks at v: mean + per_speed (v - at_speed), where `per_speed` is given; v within
    from_speed ... to_speed, m/s. `sd` is then that about the line.
    """

    measure: str
    unit: str
    sex: Sex | None
    from_age: float | None
    to_age: float | None
    from_speed: float | None
    to_speed: float | None
    n: int | None
    mean: float | None
    sd: float | None
    low: float | None
    high: float | None
    """5th and 95th percentile; of a plausibility set, the limits."""
    at_speed: float | None
    per_speed: float | None


@dataclass(frozen=True, slots=True)
class ReferenceCurve:
    """Mean and standard deviation of one degree of freedom over the stride, rad at 0, 1, ... 100 %."""

    degree_of_freedom: str
    """Without side."""
    mean: tuple[float, ...]
    sd: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ReferenceSet:
    """One folder."""

    manifest: Manifest
    strata: tuple[Stratum, ...]
    curves: Mapping[str, ReferenceCurve]
    own: bool
    """Added by the clinic; else it came with the software."""

    @property
    def measures(self) -> frozenset[str]:
        """Measures that its table tells anything of."""
        return frozenset(stratum.measure for stratum in self.strata)
