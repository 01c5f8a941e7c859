"""Rows and messages as the API shows them."""

from schemas.metrics import SessionMetrics
from services.gateway.sessions.models import CurveOut, CurvesOut, Highlights, MetricOut, MetricsOut, SessionOut
from services.gateway.tables import SessionRow


def session_out(row: SessionRow) -> SessionOut:
    """A session for the API."""
    return SessionOut(
        id=row.id,
        title=row.title,
        patient=row.patient_code,
        protocol=row.protocol,
        state=row.state,
        reason=row.reason,
        created=row.created,
        started=row.started,
        ended=row.ended,
        duration_s=row.duration_s,
        estimator=row.estimator,
        origin=row.origin,
        source=row.source,
        highlights=_highlights(row),
    )


def metrics_out(session: str, metrics: SessionMetrics) -> MetricsOut:
    """All numbers of a session for the API."""
    numbers = [MetricOut.model_validate(metric.model_dump()) for metric in metrics.metrics]
    return MetricsOut(session=session, final=metrics.final, at_s=metrics.captured_ns / 1e9, metrics=numbers)


def curves_out(session: str, metrics: SessionMetrics) -> CurvesOut:
    """All mean curves of a session for the API."""
    curves = [CurveOut.model_validate(curve.model_dump()) for curve in metrics.curves]
    return CurvesOut(session=session, final=metrics.final, curves=curves)


def stored_metrics(row: SessionRow) -> SessionMetrics | None:
    """The last metrics of a session, if any came."""
    return None if row.metrics is None else SessionMetrics.model_validate(row.metrics.body)


def _highlights(row: SessionRow) -> Highlights | None:
    metrics = stored_metrics(row)
    if metrics is None:
        return None
    whole_body = {metric.name: metric.value for metric in metrics.metrics if metric.side is None}
    return Highlights(
        walking_speed=whole_body.get("walking_speed"),
        cadence_per_min=whole_body.get("cadence"),
        strides=round(sum(metric.value or 0 for metric in metrics.metrics if metric.name == "strides_counted")),
    )
