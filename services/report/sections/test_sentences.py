"""What a timed test amounts to, in sentences."""

from collections.abc import Iterator

from schemas.metrics import Metric
from schemas.vocabulary import TASK_PHASES, Task, TaskPhaseKind
from services.report.catalogue import Catalogue
from services.report.source import ReportSource
from services.report.units import Measured


def test_sentences(source: ReportSource, words: Catalogue) -> Iterator[str]:
    """Sentences of the session's test; none for a task that is no timed test."""
    by_task = {
        Task.TIMED_UP_AND_GO: _timed_up_and_go,
        Task.SIX_MINUTE_WALK: _six_minutes,
        Task.TEN_METRE_WALK: _ten_metres,
        Task.MARCHING: _marching,
    }
    sentences = by_task.get(source.description.task)
    return iter(()) if sentences is None else sentences(source, words)


def _given(source: ReportSource, name: str) -> Metric | None:
    metric = source.metric(name)
    return None if metric is None or metric.value is None else metric


def _full(words: Catalogue, metric: Metric, *, signed: bool = False) -> str:
    return Measured.of(words, metric).full(metric.value, signed=signed)


def _timed_up_and_go(source: ReportSource, words: Catalogue) -> Iterator[str]:
    total = _given(source, "tug_time")
    if total is None:
        return
    yield words.text("summary.tug", value=_full(words, total), count=total.strides)
    kinds = TASK_PHASES[Task.TIMED_UP_AND_GO]
    parts = [(metric, kind) for kind in kinds if (metric := _given(source, f"tug_{kind}_time")) is not None]
    if parts:
        metric, kind = max(parts, key=lambda part: part[0].value or 0.0)
        yield words.text("summary.tug_longest", phase=words.text(f"phase.{kind}"), value=_full(words, metric))
        rise = _given(source, f"tug_{TaskPhaseKind.SIT_TO_STAND}_time")
        if rise is not None and kind is not TaskPhaseKind.SIT_TO_STAND:
            yield words.text("summary.tug_rise", value=_full(words, rise))


def _six_minutes(source: ReportSource, words: Catalogue) -> Iterator[str]:
    distance = _given(source, "six_minute_walk_distance")
    if distance is None:
        return
    duration = source.description.conditions.test_duration_s or 360.0
    whole = duration % 60 == 0
    minutes = words.number(duration / 60, 0 if whole else 1)
    yield words.text("summary.six", value=_full(words, distance), minutes=minutes)
    for kind in ("rests", "turns"):
        count = _given(source, f"six_minute_walk_{kind}")
        if count is not None:
            yield words.one_or_more(f"summary.{kind}", round(count.value or 0))
    slope = _given(source, "six_minute_walk_speed_slope")
    if slope is not None:
        yield words.text("summary.slope", value=_full(words, slope, signed=True))


def _ten_metres(source: ReportSource, words: Catalogue) -> Iterator[str]:
    speed = _given(source, "ten_metre_walk_speed")
    if speed is not None:
        yield words.text("summary.ten", value=_full(words, speed), count=speed.strides)


def _marching(source: ReportSource, words: Catalogue) -> Iterator[str]:
    cadence = _given(source, "marching_cadence") or _given(source, "cadence")
    if cadence is not None:
        yield words.text("summary.cadence_marching", cadence=_full(words, cadence))
