"""Minimal detectable changes as published: the clinical conventions' section 6, row by row.

A row is used only for the people, the speed and the occasion that it was measured on; nothing is borrowed.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from schemas.conditions import SpeedInstruction
from schemas.population import Population
from schemas.vocabulary import Task

TABLE_VERSION = "2026-11"
"""Of this table; frozen with every baseline."""


class Occasion(StrEnum):
    """What a threshold compares."""

    BETWEEN_DAYS = "between_days"
    WITHIN_OCCASION = "within_occasion"
    NOT_STATED = "not_stated"


class ThresholdKind(StrEnum):
    """What the number says: a change beyond measurement error, or one that people care about."""

    DETECTABLE = "mdc"
    IMPORTANT = "mcid"


@dataclass(frozen=True, slots=True)
class Band:
    """Walking speeds that a threshold is for, both ends included, m/s; null: open."""

    above: float | None
    below: float | None
    ends_included: bool

    def holds(self, speed: float) -> bool:
        """Whether a baseline speed in m/s belongs to the band."""
        if self.ends_included:
            return (self.above is None or speed >= self.above) and (self.below is None or speed <= self.below)
        return (self.above is None or speed > self.above) and (self.below is None or speed < self.below)


SLOW, MIDDLE, FAST = Band(None, 0.4, False), Band(0.4, 0.8, True), Band(0.8, None, False)


@dataclass(frozen=True, slots=True)
class Threshold:
    """One published number with all that it holds for."""

    key: str
    measures: tuple[str, ...]
    tasks: tuple[Task, ...]
    kind: ThresholdKind
    occasion: Occasion
    populations: tuple[Population, ...]
    people: str
    band: Band | None
    instruction: SpeedInstruction | None
    protocol: str
    value: float
    unit: str
    source: str
    unusable_because: str | None
    """Why no verdict may rest on it; null: it may."""


_COMFORTABLE, _FAST = SpeedInstruction.COMFORTABLE, SpeedInstruction.FAST
_STROKE = (Population.STROKE_SUBACUTE, Population.STROKE_CHRONIC)
_LEWEK, _HOSOI = "Lewek 2019, S-EPMC6361716", "Hosoi 2023, doi 10.3389/fneur.2023.1219505"
_KESAR = "Kesar 2011 (rehabpub summary)"
_ANY_START = "not stated which start and which timed distance"
_BANDS = (("slow", SLOW), ("middle", MIDDLE), ("fast", FAST))


def _banded(
    key: str, template: Threshold, values: tuple[float, float, float], measures: tuple[str, ...], unit: str
) -> list[Threshold]:
    return [
        Threshold(
            f"{key}_{name}",
            measures,
            template.tasks,
            template.kind,
            template.occasion,
            template.populations,
            template.people,
            band,
            template.instruction,
            template.protocol,
            value,
            unit,
            template.source,
            template.unusable_because,
        )
        for (name, band), value in zip(_BANDS, values, strict=True)
    ]


def _template(
    tasks: tuple[Task, ...],
    occasion: Occasion,
    populations: tuple[Population, ...],
    people: str,
    instruction: SpeedInstruction,
    source: str,
) -> Threshold:
    kind = ThresholdKind.DETECTABLE
    return Threshold(
        "", (), tasks, kind, occasion, populations, people, None, instruction, _ANY_START, 0.0, "", source, None
    )


_SPEEDS = ("walking_speed", "ten_metre_walk_speed")
_BETWEEN_DAYS = _template(
    (Task.WALK, Task.TEN_METRE_WALK),
    Occasion.BETWEEN_DAYS,
    (Population.STROKE_CHRONIC,),
    "chronic stroke, n=76",
    _COMFORTABLE,
    _LEWEK,
)
_WITHIN = _template((Task.TEN_METRE_WALK,), Occasion.WITHIN_OCCASION, _STROKE, "stroke, n=84", _COMFORTABLE, _HOSOI)
_WITHIN_FAST = _template((Task.TEN_METRE_WALK,), Occasion.WITHIN_OCCASION, _STROKE, "stroke, n=84", _FAST, _HOSOI)


def _single(
    key: str,
    measures: tuple[str, ...],
    tasks: tuple[Task, ...],
    populations: tuple[Population, ...],
    people: str,
    value: float,
    unit: str,
    source: str,
    unusable_because: str,
    kind: ThresholdKind = ThresholdKind.DETECTABLE,
) -> Threshold:
    occasion, protocol = Occasion.NOT_STATED, "not stated"
    return Threshold(
        key, measures, tasks, kind, occasion, populations, people, None, None, protocol, value, unit, source,
        unusable_because,
    )  # fmt: skip


_NO_OCCASION = "the source read does not state between days or within one occasion"
_IMPORTANCE = "says what matters to people, not what exceeds measurement error"

THRESHOLDS: tuple[Threshold, ...] = (
    *_banded("lewek_2019_comfortable_speed", _BETWEEN_DAYS, (0.10, 0.15, 0.18), _SPEEDS, "m/s"),
    *_banded("hosoi_2023_comfortable_speed", _WITHIN, (0.05, 0.11, 0.21), ("ten_metre_walk_speed",), "m/s"),
    *_banded("hosoi_2023_maximum_speed", _WITHIN_FAST, (0.04, 0.12, 0.19), ("ten_metre_walk_speed",), "m/s"),
    *_banded("hosoi_2023_comfortable_time", _WITHIN, (5.25, 2.83, 1.58), ("ten_metre_walk_time",), "s"),
    _single(
        "tilson_2010_comfortable_speed", _SPEEDS, (Task.WALK, Task.TEN_METRE_WALK), (Population.STROKE_SUBACUTE,),
        "subacute stroke, 20-60 days, n=283", 0.16, "m/s", "Tilson 2010, PMC2816032", _IMPORTANCE,
        ThresholdKind.IMPORTANT,
    ),
    _single(
        "ha_2021_tug_time", ("tug_time",), (Task.TIMED_UP_AND_GO,), (Population.STROKE_SUBACUTE,),
        "subacute stroke, pilot, n=39", 10.6, "s", "HA Convention 2021, abstract 5501", _NO_OCCASION,
    ),
    _single(
        "kesar_2011_hip_extension", ("hip_extension_peak",), (Task.WALK,), (Population.STROKE_CHRONIC,),
        "chronic stroke, n=19", math.radians(11.5), "rad", _KESAR, _NO_OCCASION,
    ),
    _single(
        "kesar_2011_temporal", ("stance_fraction",), (Task.WALK,), (Population.STROKE_CHRONIC,),
        "chronic stroke, n=19", 0.042, "1", _KESAR, _NO_OCCASION,
    ),
    _single(
        "kesar_2011_paretic_step_length", ("step_length",), (Task.WALK,), (Population.STROKE_CHRONIC,),
        "chronic stroke, n=19", 0.067, "m", _KESAR, _NO_OCCASION,
    ),
)  # fmt: skip
"""Rows marked unverified in the conventions are left out. What the conventions give but a verdict may not rest on is
here with its reason, so that a page can show it."""

BY_KEY = {threshold.key: threshold for threshold in THRESHOLDS}


def usable(
    measure: str, task: Task, occasion: Occasion, population: Population, instruction: SpeedInstruction | None
) -> list[Threshold]:
    """Thresholds that fit, of every speed band."""
    return [
        row
        for row in THRESHOLDS
        if row.unusable_because is None
        and row.kind is ThresholdKind.DETECTABLE
        and measure in row.measures
        and task in row.tasks
        and row.occasion is occasion
        and population in row.populations
        and (row.instruction is None or row.instruction is instruction)
    ]


def in_band(rows: Sequence[Threshold], speed: float | None) -> Threshold | None:
    """The row of the patient's own band, by the speed at the baseline in m/s; null where none fits."""
    return next((row for row in rows if row.band is None or (speed is not None and row.band.holds(speed))), None)
