"""Bands of services.reference as a report needs them: what each metric is set against, or why it is not."""

from collections.abc import Sequence
from typing import NamedTuple

from schemas.metrics import SessionMetrics
from schemas.vocabulary import Side
from services.reference.bands import Band, Extent, NoBand, Person, band
from services.reference.sets import ReferenceSet, SetKind
from services.report.source import RangeKind, ReferenceCurve, ReferenceGap, ReferenceOrigin, ReferenceRange

PERCENTILES = (5.0, 95.0)
CURVE_SDS = 1.0
"""Standard deviations either side of a reference curve."""


class References(NamedTuple):
    """Everything a session is set against."""

    ranges: tuple[ReferenceRange, ...]
    curves: tuple[ReferenceCurve, ...]
    gaps: tuple[ReferenceGap, ...]
    sets: tuple[str, ...]


def references_of(
    sets: Sequence[ReferenceSet], metrics: SessionMetrics, person: Person, datum: str | None
) -> References:
    """Bands of the first set that fits each metric. Curves only of sets that declare the datum of the session."""
    ranges, gaps = [], []
    for metric in metrics.metrics:
        side = None if metric.side is None else Side(metric.side)
        found = band(sets, metric.name, metric.unit, person, datum)
        if isinstance(found, NoBand):
            gaps.append(ReferenceGap(metric.name, found.value))
        else:
            ranges.append(_range(found, side))
    used = [each for each in sets if each.manifest.kind is SetKind.NORMS]
    curves = [curve for each in used if each.manifest.datum and each.manifest.datum == datum for curve in _curves(each)]
    names = tuple(f"{each.manifest.name} {each.manifest.version}" for each in used)
    return References(tuple(ranges), tuple(curves), tuple(gaps), names)


def _range(found: Band, side: Side | None) -> ReferenceRange:
    origin = ReferenceOrigin(
        name=found.set_name,
        version=found.set_version,
        source=found.citation,
        n=found.n,
        age_from=found.from_age,
        age_to=found.to_age,
        sex=found.sex,
    )
    kind: RangeKind = "percentiles" if found.extent is Extent.PERCENTILES else "from_sd"
    return ReferenceRange(found.measure, side, found.low, found.high, kind, origin)


def _curves(one: ReferenceSet) -> list[ReferenceCurve]:
    manifest = one.manifest
    origin = ReferenceOrigin(
        name=manifest.name,
        version=manifest.version,
        source=manifest.citation,
        n=manifest.n,
        age_from=None,
        age_to=None,
        sex=None,
    )
    return [
        ReferenceCurve(
            joint=name,
            low=[mean - CURVE_SDS * sd for mean, sd in zip(curve.mean, curve.sd, strict=True)],
            high=[mean + CURVE_SDS * sd for mean, sd in zip(curve.mean, curve.sd, strict=True)],
            kind="sd",
            origin=origin,
        )
        for name, curve in one.curves.items()
    ]
