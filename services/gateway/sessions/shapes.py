"""Rows and messages as the API shows them."""

import math

from schemas.kinematics import Calibration
from schemas.metrics import SessionMetrics
from schemas.tasks import Repetition, TaskPhase
from services.gateway.sessions.models import (
    CurveOut,
    CurvesOut,
    Highlights,
    MetricOut,
    MetricsOut,
    PhaseOut,
    PhasesOut,
    RepetitionOut,
    RepetitionsOut,
    SessionOut,
)
from services.gateway.sessions.told import conditions_of
from services.gateway.tables import SessionRow


def session_out(row: SessionRow) -> SessionOut:
    """A session for the API."""
    calibration = None if row.calibration is None else Calibration.model_validate(row.calibration.body)
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
        task=row.task,
        walkway_m=row.walkway_m,
        conditions=conditions_of(row),
        software=None if row.metrics is None else row.metrics.software,
        datum=None if calibration is None else calibration.datum,
        misplaced={} if calibration is None else calibration.misplaced,
        absolute=None if calibration is None else calibration.absolute,
        lengths={} if calibration is None else calibration.lengths,
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


def phases_out(session: str, metrics: SessionMetrics) -> PhasesOut:
    """Phases of timed tests for the API."""
    return PhasesOut(session=session, final=metrics.final, phases=[_phase_out(phase) for phase in metrics.phases])


def _phase_out(phase: TaskPhase) -> PhaseOut:
    ended = phase.end_ns is not None and phase.end_std_s is not None
    return PhaseOut(
        task=phase.task,
        attempt=phase.attempt,
        phase=phase.phase,
        start_s=phase.start_ns / 1e9,
        start_std_s=phase.start_std_s,
        end_s=None if phase.end_ns is None else phase.end_ns / 1e9,
        end_std_s=phase.end_std_s,
        duration_s=None if phase.end_ns is None else (phase.end_ns - phase.start_ns) / 1e9,
        duration_std_s=math.hypot(phase.start_std_s, phase.end_std_s or 0.0) if ended else None,
        largest_turn_rate=phase.largest_turn_rate,
        largest_thigh_rate=phase.largest_thigh_rate,
        steps=phase.steps,
        distance_m=phase.distance_m,
        distance_std_m=phase.distance_std_m,
    )


def repetitions_out(session: str, metrics: SessionMetrics) -> RepetitionsOut:
    """Repetitions of an exercise for the API."""
    repetitions = [_repetition_out(each) for each in metrics.repetitions]
    return RepetitionsOut(session=session, final=metrics.final, repetitions=repetitions)


def _repetition_out(repetition: Repetition) -> RepetitionOut:
    times = {f"{name}_s": getattr(repetition, f"{name}_ns") / 1e9 for name in ("start", "turn", "end")}
    kept = repetition.model_dump(exclude={"start_ns", "turn_ns", "end_ns"})
    return RepetitionOut(**times, **kept)


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
