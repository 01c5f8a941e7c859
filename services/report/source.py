"""What a report is made from: plain values, gathered by whoever has them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date, datetime
from typing import Literal

from schemas.gait import Stride
from schemas.kinematics import Calibration
from schemas.metrics import Metric, SessionMetrics
from schemas.population import Population, Sex
from schemas.session import SessionDescription
from schemas.vocabulary import Side
from services.progress.rules import Rule, Verdict


@dataclass(frozen=True, slots=True)
class Patient:
    """Who it is about: a random code and what references and thresholds are divided by."""

    code: str
    year_of_birth: int | None
    sex: Sex | None
    population: Population | None


@dataclass(frozen=True, slots=True)
class ReferenceOrigin:
    """Whose a reference is, as its set says; None where it does not."""

    name: str
    version: str
    source: str
    n: int | None
    age_from: float | None
    age_to: float | None
    sex: Sex | None


RangeKind = Literal["percentiles", "from_sd", "sd"]
"""5th to 95th percentile as published; the same of a normal distribution with the published mean and SD; mean +- SD."""


@dataclass(frozen=True, slots=True)
class ReferenceRange:
    """What people of the set have of one metric; in the metric's unit."""

    metric: str
    side: Side | None
    low: float
    high: float
    kind: RangeKind
    origin: ReferenceOrigin


@dataclass(frozen=True, slots=True)
class ReferenceCurve:
    """What people of a set that declares our datum have of one joint, in rad at 0 to 100 % in equal steps."""

    joint: str
    low: Sequence[float]
    high: Sequence[float]
    kind: RangeKind
    origin: ReferenceOrigin


@dataclass(frozen=True, slots=True)
class ReferenceGap:
    """A metric for which no set has anything that fits, and why, as the sets say it."""

    metric: str
    because: str


@dataclass(frozen=True, slots=True)
class VisitValue:
    """One visit's value with its 95 % interval, in the measure's unit, and how it stands to the baseline."""

    visit: int
    day: date
    value: float
    low: float | None
    high: float | None
    change: float | None
    verdict: Verdict | None
    rules: tuple[Rule, ...]


@dataclass(frozen=True, slots=True)
class MeasureProgress:
    """One measure over the visits up to this one. The last of `visits` is this session's, where it has a value."""

    metric: str
    side: Side | None
    unit: str
    visits: tuple[VisitValue, ...]
    baseline: float | None
    mdc: float | None
    mdc_people: str | None
    """On whom it was measured, in the words of services.progress.thresholds."""
    mdc_source: str | None
    why_no_mdc: tuple[Rule, ...]


@dataclass(frozen=True, slots=True)
class Treatment:
    """Something done for the patient; `kind` is a word of services.progress.treatments."""

    on: date
    kind: str


@dataclass(frozen=True, slots=True)
class CurveDistance:
    """RMS distance of a leg's sagittal curves from the baseline's, rad; of all four only where all are there."""

    visit: int
    side: Side
    distance: float | None
    by_variable: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Progress:
    """How the patient's visits stand to the baseline. `visit` counts from 1."""

    visit: int
    baseline_visit: int | None
    baseline_day: date | None
    measures: tuple[MeasureProgress, ...]
    treatments: tuple[Treatment, ...]
    distances: tuple[CurveDistance, ...]
    joints: tuple["JointChange", ...]


@dataclass(frozen=True, slots=True)
class JointChange:
    """Recovery or compensation of one joint since the baseline, with its reason."""

    joint: str
    word: str
    rules: tuple[Rule, ...]


@dataclass(frozen=True, slots=True)
class ReportSource:
    """Everything of one session. None where nobody has it."""

    description: SessionDescription
    metrics: SessionMetrics
    calibration: Calibration | None
    began: datetime
    patient: Patient | None
    progress: Progress | None
    references: tuple[ReferenceRange, ...]
    reference_curves: tuple[ReferenceCurve, ...]
    reference_gaps: tuple[ReferenceGap, ...]
    installed_sets: tuple[str, ...]
    """Names and versions of the reference sets that were asked, whether they fitted or not."""
    recording_sha256: str | None
    strides: tuple[Stride, ...]
    """Strides one by one, where the archive has them; for reasons of rejection and the page of all strides."""

    @property
    def paretic(self) -> Side | None:
        """The declared paretic side."""
        return self.description.conditions.paretic_side

    def metric(self, name: str, side: Side | None = None) -> Metric | None:
        """One number of the session."""
        return next((each for each in self.metrics.metrics if each.name == name and each.side == side), None)

    def value(self, name: str, side: Side | None = None) -> float | None:
        """Its value; None where it is withheld or unknown."""
        found = self.metric(name, side)
        return None if found is None else found.value

    def reference(self, name: str, side: Side | None) -> ReferenceRange | None:
        """The reference of a metric; one without a side holds for both."""
        fitting = [each for each in self.references if each.metric == name and each.side in (side, None)]
        return fitting[0] if fitting else None

    def history(self, name: str, side: Side | None) -> MeasureProgress | None:
        """A measure over the visits."""
        if self.progress is None:
            return None
        return next((each for each in self.progress.measures if (each.metric, each.side) == (name, side)), None)
