"""Stored results as the API gives them."""

from datetime import datetime

from schemas.archive_layout import parse_file_name
from schemas.metrics import Metric, SessionMetrics
from services.gateway.sessions.models import MetricOut
from services.gateway.tables import FormerMetricsRow, MetricsRow
from services.gateway.versions.models import CurveChangeOut, MetricChangeOut, VersionOut, VersionsOut
from services.versions.difference import MetricChange, difference


def versions_out(
    session: str, current: MetricsRow | None, former: list[FormerMetricsRow], files: list[str]
) -> VersionsOut:
    """The current result, then the former ones, each compared with the current one."""
    if current is None:
        return VersionsOut(session=session, versions=[])
    now = SessionMetrics.model_validate(current.body)
    newest = _version_out(now, now, current.received, None, files)
    older = [
        _version_out(SessionMetrics.model_validate(row.body), now, row.received, row.replaced, files) for row in former
    ]
    return VersionsOut(session=session, versions=[newest, *older])


def _version_out(
    result: SessionMetrics, now: SessionMetrics, stored: datetime, replaced: datetime | None, files: list[str]
) -> VersionOut:
    found = difference(result, now)
    return VersionOut(
        software=result.software,
        current=replaced is None,
        stored=stored,
        replaced=replaced,
        files=[name for name in files if _made_by(name) == result.software],
        identical=found.identical,
        metrics=[_change_out(change) for change in found.metrics],
        curves=[
            CurveChangeOut(degree_of_freedom=curve.degree_of_freedom, largest=curve.largest) for curve in found.curves
        ],
    )


def _made_by(file_name: str) -> str | None:
    name = parse_file_name(file_name)
    return None if name is None or name.version is None else f"ambula {name.version}"


def _change_out(change: MetricChange) -> MetricChangeOut:
    metric = change.metric
    return MetricChangeOut.model_validate(
        {
            "name": metric.name,
            "side": metric.side,
            "unit": metric.unit,
            "kind": change.kind,
            "before": _metric_out(change.before),
            "after": _metric_out(change.after),
            "change": change.change,
            "change_in_intervals": change.change_in_intervals,
        }
    )


def _metric_out(metric: Metric | None) -> MetricOut | None:
    return None if metric is None else MetricOut.model_validate(metric.model_dump())
