"""Our units as UCUM. Angles leave in degrees: a value travels with its unit, and readers show it as it comes."""

import math
from typing import Any, NamedTuple

UCUM = "http://unitsofmeasure.org"


class Ucum(NamedTuple):
    """A UCUM unit, what a person reads, and by what our number is multiplied."""

    code: str
    display: str
    factor: float


_DEGREES = 180.0 / math.pi
UNITS: dict[str, Ucum] = {
    "1": Ucum("1", "", 1.0),
    "s": Ucum("s", "s", 1.0),
    "m": Ucum("m", "m", 1.0),
    "m/s": Ucum("m/s", "m/s", 1.0),
    "m/s/min": Ucum("m/s/min", "m/s per minute", 1.0),
    "rad": Ucum("deg", "deg", _DEGREES),
    "rad/s": Ucum("deg/s", "deg/s", _DEGREES),
    "rad/repetition": Ucum("deg/{repetition}", "deg per repetition", _DEGREES),
    "steps/min": Ucum("{steps}/min", "steps/min", 1.0),
    "repetitions/min": Ucum("{repetitions}/min", "repetitions/min", 1.0),
}
"""By the unit of a metric. Curly brackets are UCUM's annotations: a step is dimensionless."""

DIGITS = 9
"""Significant decimal digits; more would be noise of the floating point."""


def quantity(value: float, unit: str) -> dict[str, Any]:
    """A FHIR Quantity. Raises KeyError for a unit that no metric has."""
    ucum = UNITS[unit]
    said = {"value": float(f"{value * ucum.factor:.{DIGITS}g}")}
    return said | ({"unit": ucum.display} if ucum.display else {}) | {"system": UCUM, "code": ucum.code}
