"""Reference sets and bands as the API shows them."""

from schemas.metrics import Metric, SessionMetrics
from services.gateway.references.models import (
    BandOut,
    MetricReferenceOut,
    ReferenceSetOut,
    StratumOut,
)
from services.progress.measures import is_followed
from services.reference.bands import NoBand, Person, band, position
from services.reference.folders import Shelf
from services.reference.sets import ReferenceSet


def set_out(one: ReferenceSet) -> ReferenceSetOut:
    """One set with its rows."""
    return ReferenceSetOut(
        **one.manifest.model_dump(),
        own=one.own,
        strata=[StratumOut.model_validate(stratum) for stratum in one.strata],
        curves=sorted(one.curves),
    )


def metrics_against(
    shelf: Shelf, metrics: SessionMetrics, person: Person, datum: str | None
) -> list[MetricReferenceOut]:
    """Every metric that says something of the person; counts say how much was seen."""
    return [_against(shelf, metric, person, datum) for metric in metrics.metrics if is_followed(metric.name)]


def _against(shelf: Shelf, metric: Metric, person: Person, datum: str | None) -> MetricReferenceOut:
    found = band(shelf.sets, metric.name, metric.unit, person, datum)
    fits = None if isinstance(found, NoBand) else found
    return MetricReferenceOut(
        measure=metric.name,
        side=metric.side,
        unit=metric.unit,
        band=None if fits is None else BandOut.model_validate(fits),
        position=None if fits is None or metric.value is None else position(metric.value, fits),
        because=found if isinstance(found, NoBand) else None,
    )
