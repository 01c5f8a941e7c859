"""What was not measured and why, what was withheld and why, what was left out and why."""

from schemas.metrics import Metric
from schemas.vocabulary import Segment, Side, Task
from services.definitions.variability import ENDS, REJECTED, TURNING
from services.report.catalogue import Catalogue
from services.report.content import Section, SectionId
from services.report.phrases import why_withheld
from services.report.sections.header import count_of
from services.report.sections.scope import EXERCISES, in_scope
from services.report.source import ReportSource

MOST_WITHHELD = 8
"""Reasons told at most; metrics with the same reason are told together."""


def limits(source: ReportSource, words: Catalogue) -> Section:
    """Always there."""
    exercise = source.description.task in EXERCISES
    sentences = [*_not_measured(source, words, exercise=exercise), *_withheld(source, words)]
    sentences.append(_repetitions_left_out(source, words) if exercise else _strides_left_out(source, words))
    notes = []
    if source.value("double_support_fraction") is not None:
        notes.append(words.text("limits.double_support"))
    if source.metrics.curves or exercise:
        notes.append(words.text("limits.angles"))
    if source.description.task is Task.TIMED_UP_AND_GO:
        notes.append(words.text("limits.stopwatch"))
    return Section(
        id=SectionId.LIMITS, page=2, title=words.text("title.limits"), sentences=sentences, charts=[], table=None,
        notes=notes,
    )  # fmt: skip


def _not_measured(source: ReportSource, words: Catalogue, *, exercise: bool) -> list[str]:
    worn = {sensor.segment for hub in source.description.hubs for sensor in hub.sensors}
    items = []
    if not exercise:
        if source.value("step_width") is None:
            items.append("width")
        if source.value("stride_length") is None and source.value("step_length", Side.LEFT) is None:
            items.append("lengths")
    if worn and not source.description.cameras:
        if not {Segment.FOOT_LEFT, Segment.FOOT_RIGHT} & worn:
            items.append("ankle")
        items.append("transverse")
    texts = [words.text(f"limits.{item}") for item in items]
    for side in Side:
        legs = {Segment(f"{part}_{side}") for part in ("thigh", "shank", "foot")}
        if worn and not source.description.cameras and not legs & worn:
            texts.append(words.text("limits.one_side", side=words.text(f"side.of_{side}")))
    return [words.text("limits.not_measured", items=words.text("format.semicolon").join(texts))] if texts else []


def _withheld(source: ReportSource, words: Catalogue) -> list[str]:
    by_reason: dict[str, list[str]] = {}
    for metric in in_scope(source):
        if metric.value is None and metric.strides > 0:
            names = by_reason.setdefault(why_withheld(words, metric), [])
            name = _named(words, metric)
            if name not in names:
                names.append(name)
    told = list(by_reason.items())[:MOST_WITHHELD]
    sentences = [words.text("limits.withheld", name=", ".join(names), reason=reason) for reason, names in told]
    if len(by_reason) > MOST_WITHHELD:
        sentences.append(words.text("limits.and_more", count=len(by_reason) - MOST_WITHHELD))
    return sentences


def _named(words: Catalogue, metric: Metric) -> str:
    name = words.metric(metric.name)
    if metric.side is None:
        return name
    return words.text("format.brackets", text=name, inside=words.text(f"side.{metric.side}"))


def _strides_left_out(source: ReportSource, words: Catalogue) -> str:
    counts = (("rejected", REJECTED), ("turning", TURNING), ("ends", ENDS))
    items = [words.text(f"limits.{key}", count=count) for key, name in counts if (count := count_of(source, name))]
    if not items:
        return words.text("limits.none_left_out")
    return words.text("limits.strides", items=", ".join(items)) + _why(source, words)


def _why(source: ReportSource, words: Catalogue) -> str:
    reasons: dict[str, int] = {}
    for stride in source.strides:
        if stride.rejected_because:
            reasons[stride.rejected_because] = reasons.get(stride.rejected_because, 0) + 1
    if not reasons:
        return ""
    parts = [f"{_reason(words, reason)} ({count})" for reason, count in sorted(reasons.items())]
    return " " + words.text("limits.because", reasons=words.text("format.semicolon").join(parts))


def _reason(words: Catalogue, reason: str) -> str:
    key = f"reason.{reason}"
    return words.text(key) if words.has(key) else words.text("reason.rejected")


def _repetitions_left_out(source: ReportSource, words: Catalogue) -> str:
    rejected = [each for each in source.metrics.repetitions if not each.valid]
    if not rejected:
        return words.text("limits.no_repetitions_left_out")
    reasons: dict[str, int] = {}
    for each in rejected:
        text = _reason(words, each.rejected_because or "")
        reasons[text] = reasons.get(text, 0) + 1
    items = words.text("format.semicolon").join(f"{text} ({count})" for text, count in sorted(reasons.items()))
    return words.text("limits.repetitions", items=items)
