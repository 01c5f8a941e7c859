"""Visits as the API shows them."""

from services.gateway.sessions.models import MetricOut
from services.gateway.sessions.shapes import session_out, stored_metrics
from services.gateway.tables import SessionRow
from services.gateway.visits.models import VisitOut, VisitSessionOut
from services.progress.baseline import Baseline, is_usable
from services.progress.measures import ORDER, place
from services.progress.visits import Trial, Visit


def visit_out(visit: Visit, rows: dict[str, SessionRow], baseline: Baseline | None) -> VisitOut:
    """One visit. `rows` holds its sessions by id."""
    counted = baseline is not None and baseline.session in {trial.session for trial in visit.trials}
    sessions = [_session_out(trial, rows[trial.session]) for trial in visit.trials]
    return VisitOut(visit=visit.number, day=visit.day, baseline=counted, sessions=sessions)


def _session_out(trial: Trial, row: SessionRow) -> VisitSessionOut:
    shown = session_out(row)
    return VisitSessionOut(
        session=trial.session,
        title=shown.title,
        began=trial.began,
        duration_s=shown.duration_s,
        state=shown.state,
        task=shown.task,
        conditions=shown.conditions,
        estimator=shown.estimator,
        software=shown.software,
        usable=is_usable(trial),
        metrics=_headlines(row),
    )


def _headlines(row: SessionRow) -> list[MetricOut]:
    metrics = stored_metrics(row)
    if metrics is None:
        return []
    named = sorted((each for each in metrics.metrics if each.name in ORDER), key=lambda each: place(each.name))
    return [MetricOut.model_validate(each.model_dump()) for each in named]
