"""Rows of `curves.csv` as mean curves, checked."""

import math
from collections.abc import Mapping, Sequence

from schemas.gait import CURVE_POINTS
from services.reference.errors import ReferenceSetError
from services.reference.sets import ReferenceCurve

COLUMNS = ("degree_of_freedom", "percent", "mean", "sd")
"""Degree of freedom without side; 0, 1, ... 100 % of the stride in order; rad, flexion positive."""


def curves_of(folder: str, rows: Sequence[Mapping[str, str]]) -> dict[str, ReferenceCurve]:
    """Degree of freedom -> curve. Raises ReferenceSetError with the line."""
    if set(rows[0]) != set(COLUMNS):
        raise ReferenceSetError(folder, "curves.csv: line 1", f"the columns are {', '.join(COLUMNS)}")
    told: dict[str, list[tuple[float, float]]] = {}
    for line, row in enumerate(rows, start=2):
        curve = told.setdefault(row["degree_of_freedom"].strip(), [])
        try:
            percent, mean, sd = (float(row[name]) for name in COLUMNS[1:])
        except ValueError:
            raise ReferenceSetError(folder, f"curves.csv: line {line}", "percent, mean and sd are numbers") from None
        if percent != len(curve) or not math.isfinite(mean) or not (math.isfinite(sd) and sd > 0):
            what = f"{len(curve)} % should follow, with a finite mean and a positive sd"
            raise ReferenceSetError(folder, f"curves.csv: line {line}", what)
        curve.append((mean, sd))
    for name, curve in told.items():
        if len(curve) != CURVE_POINTS:
            raise ReferenceSetError(folder, "curves.csv", f"{name} has {len(curve)} rows instead of {CURVE_POINTS}")
    return {
        name: ReferenceCurve(name, tuple(mean for mean, _ in curve), tuple(sd for _, sd in curve))
        for name, curve in told.items()
    }
