"""Units as devices and laboratories write them, and their size in SI."""

import math

from services.ingest.errors import UnknownUnit

STANDARD_GRAVITY = 9.80665
"""m/s^2, by definition of the unit g."""

LOCAL_GRAVITY = 9.81
"""m/s^2, what a resting accelerometer is expected to show."""

_DEGREE = math.pi / 180

SCALES: dict[str, dict[str, float]] = {
    "specific force": {"m/s^2": 1.0, "g": STANDARD_GRAVITY, "mg": STANDARD_GRAVITY / 1000},
    "angular velocity": {"rad/s": 1.0, "deg/s": _DEGREE, "mdeg/s": _DEGREE / 1000},
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9},
    "angle": {"rad": 1.0, "deg": _DEGREE},
    "length": {"m": 1.0, "cm": 1e-2, "mm": 1e-3},
    "speed": {"m/s": 1.0, "km/h": 1 / 3.6},
    "number": {"1": 1.0, "%": 1e-2},
}
"""Quantity -> unit -> size in SI. The first unit of each quantity is the SI one."""


def scale_to_si(quantity: str, unit: str) -> float:
    """Factor from `unit` to SI. Raises UnknownUnit, naming what would be understood."""
    known = SCALES[quantity]
    if unit not in known:
        raise UnknownUnit(f"unit {unit!r} of {quantity} is unknown; write one of {', '.join(known)}")
    return known[unit]


def reference_unit(unit: str) -> tuple[float, str]:
    """Factor to SI and the SI unit of a reference channel. Raises UnknownUnit."""
    for known in SCALES.values():
        if unit in known:
            return known[unit], next(iter(known))
    every = ", ".join(name for known in SCALES.values() for name in known)
    raise UnknownUnit(f"unit {unit!r} is unknown; write one of {every}")
