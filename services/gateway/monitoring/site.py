"""What is read at each scrape: services, sessions, viewers, audit, disk. Labels: service, position, clinic, state."""

import shutil
from collections.abc import Iterable, Iterator
from pathlib import Path

from prometheus_client import CollectorRegistry
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector
from sqlalchemy import func, select
from sqlalchemy.exc import SQLAlchemyError

from schemas.health import Health, Readiness, Reason
from services.gateway.access.scope import EVERYTHING
from services.gateway.audit.tables import AuditHeadRow
from services.gateway.database import Database
from services.gateway.health.board import SERVICES, HealthBoard
from services.gateway.live.hub import LiveHub
from services.gateway.tables import SessionRow

COUNTS = {
    "cpu_s": ("ambula_service_cpu_seconds", "Processor time."),
    "dropped": ("ambula_service_dropped", "Messages dropped because a queue was full; data is asked for again."),
    "errors": ("ambula_service_errors", "Unexpected exceptions; each is in the log."),
    "lost": ("ambula_service_lost", "Messages that nobody has any more."),
}
REASONS = frozenset(reason.value for reason in Reason)


class SiteNumbers(Collector):
    """Asks the parts of the gateway when it is asked."""

    def __init__(self, live: LiveHub, database: Database, data_dir: Path) -> None:
        self._live = live
        self._database = database
        self._data_dir = data_dir

    def collect(self) -> Iterable[Metric]:
        """All families. A database that is away leaves its own out."""
        yield from _service_gauges(self._live.health)
        yield from _service_counters(self._live.health)
        yield from self._viewers()
        yield from self._stored()
        yield from self._disk()

    def describe(self) -> Iterable[Metric]:
        """Nothing is asked when this is registered."""
        return ()

    def _viewers(self) -> Iterator[Metric]:
        audience = self._live.audience
        viewers = GaugeMetricFamily("ambula_live_viewers", "Open live connections.", labels=["clinic"])
        for clinic, count in audience.sizes().items():
            viewers.add_metric([clinic], count)
        skipped = CounterMetricFamily(
            "ambula_live_skipped_poses",
            "Skeletons and lists out of date before a browser took them.",
            labels=["clinic"],
        )
        for clinic, count in audience.skipped().items():
            skipped.add_metric([clinic], count)
        yield from (viewers, skipped)

    def _stored(self) -> Iterator[Metric]:
        up = GaugeMetricFamily("ambula_database_up", "The database answers.")
        sessions = GaugeMetricFamily("ambula_sessions", "Stored sessions.", labels=["clinic", "state"])
        audit = GaugeMetricFamily("ambula_audit_entries", "Length of the audit's chain.")
        try:
            with self._database.transaction(EVERYTHING) as database:
                counted = select(SessionRow.clinic_id, SessionRow.state, func.count())
                for clinic, state, count in database.execute(counted.group_by(SessionRow.clinic_id, SessionRow.state)):
                    sessions.add_metric([clinic, state], count)
                audit.add_metric([], database.scalar(select(AuditHeadRow.number)) or 0)
            up.add_metric([], 1)
        except SQLAlchemyError:
            up.add_metric([], 0)
        yield from (up, sessions, audit)

    def _disk(self) -> Iterator[Metric]:
        free = GaugeMetricFamily("ambula_disk_free_bytes", "Free space in the data folder's file system.")
        total = GaugeMetricFamily("ambula_disk_size_bytes", "Size of the data folder's file system.")
        folder = self._data_dir.resolve()
        usage = shutil.disk_usage(next(path for path in (folder, *folder.parents) if path.exists()))
        free.add_metric([], usage.free)
        total.add_metric([], usage.total)
        yield from (free, total)


def _service_gauges(board: HealthBoard) -> Iterator[Metric]:
    """One value per service: the youngest report's age, what its fresh instances use and hold together."""
    heard: dict[str, list[tuple[Health, float]]] = {service: [] for service in (*SERVICES, "gateway")}
    for health, age_s in board.reports():
        heard.setdefault(health.service, []).append((health, age_s))
    up = GaugeMetricFamily("ambula_service_up", "An instance reports.", labels=["service"])
    ready = GaugeMetricFamily(
        "ambula_service_ready", "An instance does its work; 0 while compiling.", labels=["service"]
    )
    age = GaugeMetricFamily("ambula_service_report_age_seconds", "Since the last report.", labels=["service"])
    rss = GaugeMetricFamily("ambula_service_resident_bytes", "Resident memory.", labels=["service"])
    queue = GaugeMetricFamily("ambula_service_queue_messages", "Messages that wait.", labels=["service"])
    capacity = GaugeMetricFamily(
        "ambula_service_queue_capacity_messages", "Messages that may wait.", labels=["service"]
    )
    for service, reports in heard.items():
        fresh = [health for health, age_s in reports if not board.is_stale(age_s)]
        up.add_metric([service], bool(fresh))
        ready.add_metric([service], any(each.readiness is Readiness.READY for each in fresh))
        if reports:
            age.add_metric([service], min(age_s for _, age_s in reports))
        rss.add_metric([service], sum(each.rss_bytes for each in fresh))
        queue.add_metric([service], sum(each.queue_length for each in fresh))
        capacity.add_metric([service], sum(each.queue_capacity for each in fresh))
    yield from (up, ready, age, rss, queue, capacity)


def _service_counters(board: HealthBoard) -> Iterator[Metric]:
    families = {what: CounterMetricFamily(*named, labels=["service"]) for what, named in COUNTS.items()}
    rejected = CounterMetricFamily(
        "ambula_rejected",
        "Samples and messages not used; position: of the sensor.",
        labels=["service", "position", "reason"],
    )
    for counted, sum_ in board.tally.sums().items():
        if counted.what in families:
            families[counted.what].add_metric([counted.service], sum_)
        elif counted.what in REASONS:
            rejected.add_metric([counted.service, counted.position, counted.what], sum_)
    yield from (*families.values(), rejected)


def site_registry(live: LiveHub, database: Database, data_dir: Path) -> CollectorRegistry:
    """A registry of its own for each gateway, so that two in one process do not mix."""
    registry = CollectorRegistry()
    registry.register(SiteNumbers(live, database, data_dir))
    return registry
