"""Columns of tables: what each holds, and what it means."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from schemas.payload import Payload

Cell = str | float | int | bool | None
Row = list[Cell]


class Column(NamedTuple):
    """One column: `value` of one entry, `meaning` with its unit."""

    name: str
    meaning: str
    value: Callable[[Any], Cell]


def plain(model: type[Payload], *names: str) -> tuple[Column, ...]:
    """Fields as they are, in the unit that the schema names."""
    return tuple(Column(name, model.model_fields[name].description or "", field(name)) for name in names)


def times(model: type[Payload], *names: str) -> tuple[Column, ...]:
    """Fields in ns as columns in s."""
    return tuple(Column(f"{name}_s", _time_meaning(model, name), seconds(name)) for name in names)


def angles(model: type[Payload], *names: str) -> tuple[Column, ...]:
    """Fields in rad, then the same in degrees."""
    of_both = []
    for name in names:
        text = model.model_fields[name].description or "rad"
        of_both.append(Column(name, text if "rad" in text else f"rad; {text}", field(name)))
        of_both.append(Column(f"{name}_deg", f"{name} in degrees", degrees(field(name))))
    return tuple(of_both)


def field(name: str) -> Callable[[Any], Cell]:
    """A field as it is."""
    return lambda entry: getattr(entry, name)


def seconds(name: str) -> Callable[[Any], Cell]:
    """A field in ns, without that ending, in s."""

    def value(entry: Any) -> Cell:
        time = getattr(entry, f"{name}_ns")
        return None if time is None else f"{time * 1e-9:.6f}"

    return value


def degrees(angle: Callable[[Any], Cell]) -> Callable[[Any], Cell]:
    """An angle in degrees."""

    def value(entry: Any) -> Cell:
        of_entry = angle(entry)
        return math.degrees(of_entry) if isinstance(of_entry, float) else None

    return value


def _time_meaning(model: type[Payload], name: str) -> str:
    text = model.model_fields[f"{name}_ns"].description or ""
    return f"s; {text}" if text and not text.startswith("ns ") else "s since the session started"
