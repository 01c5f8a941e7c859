"""Scoreboard of the web application: real processes, live patients, many who watch, one who never reads."""

import statistics
import threading
from collections.abc import Iterator, Sequence
from pathlib import Path

from services.bench.scoreboard import Row, Scoreboard, at_least, at_most, informative
from services.bench.web import pages
from services.bench.web.flood import flood
from services.bench.web.site import Cost, Site, open_site
from services.bench.web.viewers import Seen, watch
from services.cli import browser as browsers

PATIENTS = 16
CLIENTS = 40
WARM_UP_S = 15.0
WATCH_S = 30.0
FLOOD_S = 10.0
FLOOD_PER_S = 1000.0
FRAMES_S = 10.0
SMALL = "small"
"""Word for a few patients and clients, to see that it runs."""

NOTE = (
    "Latency: from the capture of a skeleton's newest sample to its receipt at a client, on this machine's monotonic"
    " clock. A synthetic sample is captured when its time has come; time zero of a session is the earliest"
    " (arrival - sample time) of its sensors' messages on the bus. It holds batching by the hub, the estimator and the"
    " 40 ms between two skeletons. A gap is the time between two skeletons at one client."
)


def run(json_path: Path | None = None, *subject: str) -> Scoreboard:
    """Three minutes. With `small`, two patients and four clients."""
    if set(subject) - {SMALL}:
        raise ValueError(f"web takes nothing or the word {SMALL}, not {' '.join(subject)!r}")
    patients, clients, seconds = (2, 4, 8.0) if subject else (PATIENTS, CLIENTS, WATCH_S)
    with open_site(patients) as site:
        watch(site, clients, WARM_UP_S, stalled=False)
        rows = [*_live_rows(site, clients, seconds), *_flood_rows(site, clients), *_page_rows(site)]
    scoreboard = Scoreboard(f"web: {patients} patients, {clients} clients", rows, NOTE)
    if json_path is not None:
        scoreboard.write_json(json_path)
    return scoreboard


def _live_rows(site: Site, clients: int, seconds: float) -> Iterator[Row]:
    with Cost(site.gateway_pid) as cost:
        alone = watch(site, clients, seconds, stalled=False)
        beside = watch(site, clients - 1, seconds, stalled=True)
    yield at_most("sensor to browser, p99", 1e3 * _p99(alone.latency_s), "ms", 100)
    yield informative("sensor to browser, median", 1e3 * statistics.median(alone.latency_s), "ms")
    yield informative("sensor to browser, p99, one client never reads", 1e3 * _p99(beside.latency_s), "ms")
    yield informative("gap between skeletons, p95", 1e3 * _p95(alone.gap_s), "ms")
    growth_s = _p95(beside.gap_s) - _p95(alone.gap_s)
    yield at_most("growth of that when one client never reads", 1e3 * growth_s, "ms", 10)
    yield at_most("others that were let go", alone.closed + beside.closed, "clients", 0)
    yield informative("skeletons received", len(alone.gap_s) + len(beside.gap_s), "1")
    yield informative("gateway, processor", statistics.fmean(cost.cores), "cores")
    yield informative("gateway, memory", max(cost.rss_mb), "MB")
    yield at_most("gateway, growth of memory", cost.growth_mb, "MB", 10)


def _flood_rows(site: Site, clients: int) -> Iterator[Row]:
    seen: list[Seen] = []
    watching = threading.Thread(target=lambda: seen.append(watch(site, clients // 4, FLOOD_S + 3, stalled=False)))
    with Cost(site.gateway_pid) as cost:
        watching.start()
        told = flood(site, FLOOD_PER_S, FLOOD_S)
        watching.join()
    yield at_most("flood: sensor to browser, p99", 1e3 * _p99(seen[0].latency_s), "ms", 250)
    yield at_most("flood: growth of memory", cost.growth_mb, "MB", 50)
    yield informative("flood: requests answered", told.total() / FLOOD_S, "1/s")
    yield informative("flood: of these refused with 429", told[429] / max(1, told.total()), "1")
    yield at_most("flood: answers other than 200 and 429", told.total() - told[200] - told[429], "1", 0)


def _page_rows(site: Site) -> Iterator[Row]:
    missing = browsers.absent()
    if missing is not None:
        yield Row("frames of the live page", None, "1/s", missing, None, None)
        return
    page = pages.look(site, FRAMES_S)
    yield at_least("frames of the live page, WebGL in software", page.fps, "1/s", 20)
    yield at_most("first paint", page.first_paint_s, "s", 1.5)
    yield at_most("initial load, gzip", page.gzip_kb, "kB", 400)
    yield at_most("initial load and the live page, gzip", page.live_kb, "kB", 400)
    yield at_most("hosts asked beside our own", page.foreign_hosts, "1", 0)


def _p99(values: Sequence[float]) -> float:
    return statistics.quantiles(values, n=100)[98]


def _p95(values: Sequence[float]) -> float:
    return statistics.quantiles(values, n=20)[18]
