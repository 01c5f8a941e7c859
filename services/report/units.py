"""The display edge of the report: the one place where radians become degrees, metres centimetres, shares per cent."""

import math
from typing import NamedTuple

from schemas.metrics import Metric
from services.report.catalogue import NO_BREAK, Catalogue

PER_CENT_SUFFIXES = ("_fraction", "_cv", "_timing", "_asymmetry", "_share", "_support", "_change")
LENGTHS_IN_CM = ("step_length", "stride_length", "step_width", "circumduction")


class Shown(NamedTuple):
    """How a quantity is shown: `value * factor`, digits after the mark, key of the unit's symbol."""

    factor: float
    unit: str
    digits: int


_BY_UNIT: dict[str, Shown] = {
    "rad": Shown(180 / math.pi, "degree", 1),
    "rad/s": Shown(180 / math.pi, "degree_per_s", 0),
    "rad/repetition": Shown(180 / math.pi, "degree_per_repetition", 2),
    "m": Shown(1, "m", 2),
    "m/s": Shown(1, "m_per_s", 2),
    "m/s/min": Shown(1, "m_per_s_per_min", 3),
    "s": Shown(1, "s", 2),
    "steps/min": Shown(1, "steps_per_min", 0),
    "repetitions/min": Shown(1, "repetitions_per_min", 1),
}


def shown(unit: str, name: str) -> Shown:
    """How the metric `name`, whose wire unit is `unit`, is shown."""
    if unit == "m" and name.startswith(LENGTHS_IN_CM):
        return Shown(100, "cm", 1)
    if unit == "m" and "_walk_distance" in name:
        return Shown(1, "m", 0)
    if unit == "1" and "_ratio" not in name and name.endswith(PER_CENT_SUFFIXES):
        return Shown(100, "percent", 1)
    if unit == "1" and "_ratio" not in name and "_shape" not in name:
        return Shown(1, "", 0)
    return _BY_UNIT.get(unit, Shown(1, "", 2))


class Measured:
    """Formats values of one metric in one language."""

    def __init__(self, words: Catalogue, unit: str, name: str) -> None:
        self.words = words
        self.how = shown(unit, name)

    @classmethod
    def of(cls, words: Catalogue, metric: Metric) -> "Measured":
        """For the metric's own unit and name."""
        return cls(words, metric.unit, metric.name)

    @property
    def symbol(self) -> str:
        """The unit's symbol, empty where there is none."""
        return self.words.text(f"unit.{self.how.unit}") if self.how.unit else ""

    def bare(self, value: float | None, *, signed: bool = False) -> str:
        """The number without its unit."""
        return self.words.number(None if value is None else value * self.how.factor, self.how.digits, signed=signed)

    def full(self, value: float | None, *, signed: bool = False) -> str:
        """The number with its unit, kept on one line."""
        return self.with_unit(self.bare(value, signed=signed))

    def span(self, low: float, high: float) -> str:
        """`low to high unit`."""
        return self.with_unit(self.words.text("format.span", low=self.bare(low), high=self.bare(high)))

    def with_unit(self, text: str) -> str:
        """Text and unit; the degree sign of an angle stands close to its number."""
        if not self.symbol:
            return text
        return f"{text}{self.symbol}" if self.symbol == "°" else f"{text}{NO_BREAK}{self.symbol}"
