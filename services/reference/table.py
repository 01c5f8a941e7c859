"""Rows of `table.csv` as strata, checked."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import fields

from schemas.population import Sex
from services.reference.errors import ReferenceSetError
from services.reference.sets import Manifest, SetKind, Stratum

COLUMNS = tuple(field.name for field in fields(Stratum))
"""Of the header, in any order; a column that is left out is empty in every row."""

NEEDED = ("measure", "unit")
UNITS = ("m", "s", "m/s", "rad", "1", "steps/min")
"""SI, as metrics have them; degrees, % and cm exist on screens only."""

_WORDS = ("measure", "unit", "sex")
_PAIRS = (("from_age", "to_age"), ("from_speed", "to_speed"), ("low", "high"))


def strata_of(folder: str, rows: Sequence[Mapping[str, str]], manifest: Manifest) -> tuple[Stratum, ...]:
    """All rows. Raises ReferenceSetError with the line."""
    unknown = [name for name in rows[0] if name not in COLUMNS]
    missing = [name for name in NEEDED if name not in rows[0]]
    if unknown or missing:
        what = f"unknown column {unknown[0]!r}" if unknown else f"no column {missing[0]!r}"
        raise ReferenceSetError(folder, "table.csv: line 1", f"{what}; there are {', '.join(COLUMNS)}")
    strata = []
    for line, row in enumerate(rows, start=2):
        try:
            strata.append(_checked(_stratum(row), manifest))
        except ValueError as error:
            raise ReferenceSetError(folder, f"table.csv: line {line}", str(error)) from error
    return tuple(strata)


def _stratum(row: Mapping[str, str]) -> Stratum:
    words = {name: (row.get(name) or "").strip() for name in COLUMNS}
    numbers = {name: _number(name, text) for name, text in words.items() if name not in _WORDS}
    people = numbers.pop("n")
    if people is not None and (people < 1 or people != int(people)):
        raise ValueError(f"n is {people:g}, not a number of people")
    return Stratum(
        measure=words["measure"],
        unit=words["unit"],
        sex=_sex(words["sex"]),
        n=None if people is None else int(people),
        **numbers,
    )


def _number(name: str, text: str) -> float | None:
    if not text:
        return None
    try:
        number = float(text)
    except ValueError:
        raise ValueError(f"{name} is {text!r}, not a number") from None
    if not math.isfinite(number):
        raise ValueError(f"{name} is {text!r}, not finite")
    return number


def _sex(text: str) -> Sex | None:
    try:
        return Sex(text) if text else None
    except ValueError:
        raise ValueError(f"sex is {text!r}; it is female, male or empty for both") from None


def _checked(stratum: Stratum, manifest: Manifest) -> Stratum:
    if not stratum.measure:
        raise ValueError("measure is empty")
    if stratum.unit not in UNITS:
        raise ValueError(f"unit is {stratum.unit!r}; it is one of {', '.join(UNITS)}")
    if stratum.unit == "rad" and manifest.datum is None:
        raise ValueError("an angle needs a datum in the manifest: say what an angle of zero means")
    for low, high in _PAIRS:
        bottom, top = getattr(stratum, low), getattr(stratum, high)
        if bottom is not None and top is not None and bottom > top:
            raise ValueError(f"{low} is larger than {high}")
    if stratum.sd is not None and (stratum.sd <= 0 or stratum.mean is None):
        raise ValueError("sd must be positive and have a mean beside it")
    if stratum.mean is None and (stratum.low is None or stratum.high is None):
        raise ValueError("has neither a mean nor both limits")
    if manifest.kind is SetKind.PLAUSIBILITY and (stratum.low is None or stratum.high is None):
        raise ValueError("a plausibility set gives low and high")
    _check_line(stratum)
    return stratum


def _check_line(stratum: Stratum) -> None:
    line = (stratum.at_speed, stratum.per_speed)
    if line == (None, None):
        return
    if None in (*line, stratum.mean, stratum.sd, stratum.from_speed, stratum.to_speed):
        raise ValueError("a line over speed needs at_speed, per_speed, mean, sd, from_speed and to_speed")
