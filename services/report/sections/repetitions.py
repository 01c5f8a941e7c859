"""An exercise: its numbers side by side, and the range of each repetition."""

import math

from schemas.vocabulary import Side
from services.report.catalogue import Catalogue
from services.report.charts.bar_chart import Bar, BarLabels, bar_chart
from services.report.content import Chart, Section, SectionId
from services.report.phrases import joint_name
from services.report.sections.measure_table import measure_table
from services.report.sections.scope import in_scope
from services.report.sections.table_notes import table_notes
from services.report.source import ReportSource

DEGREES = 180 / math.pi
MOST_BARS = 60
"""Repetitions drawn at most, the newest."""


def repetitions(source: ReportSource, words: Catalogue) -> Section | None:
    """None where nothing of an exercise was seen."""
    told = [each.name for each in in_scope(source) if "_ratio_" not in each.name]
    names = list(dict.fromkeys(name for name in told if name.startswith("repetition")))
    title = words.text("title.repetitions")
    table = measure_table(source, words, names, title)
    charts = _charts(source, words)
    if table is None and not charts:
        return None
    notes = table_notes(source, words, names) + ([words.text("note.repetition_bars")] if charts else [])
    return Section(id=SectionId.REPETITIONS, page=1, title=title, sentences=[], charts=charts, table=table, notes=notes)


def _charts(source: ReportSource, words: Catalogue) -> list[Chart]:
    followed: dict[str, list[Bar]] = {}
    for each in source.metrics.repetitions[-MOST_BARS:]:
        extent = abs(each.turn_angle - (each.start_angle + each.end_angle) / 2) * DEGREES
        followed.setdefault(each.degree_of_freedom, []).append(Bar(each.side, extent, each.valid))
    return [_chart(words, name, bars, len(followed)) for name, bars in followed.items()]


def _chart(words: Catalogue, followed: str, bars: list[Bar], count: int) -> Chart:
    title = joint_name(words, followed)
    sides: dict[Side | None, list[float]] = {}
    for bar in bars:
        sides.setdefault(bar.side, []).append(bar.value)
    parts = " ".join(
        words.text(
            "chart.repetitions_alt_side",
            side=words.text("chart.whole" if side is None else f"column.{side}"),
            count=len(values),
            low=f"{words.number(min(values), 0)}°",
            high=f"{words.number(max(values), 0)}°",
        )
        for side, values in sides.items()
    )
    alt = words.text("chart.repetitions_alt", sides=parts)
    labels = BarLabels(
        title, alt, words.text("chart.repetition_axis"), words.text("chart.range_axis"),
        words.text("format.decimal_mark"),
    )  # fmt: skip
    identity = f"repetitions-{followed.replace('_', '-')}"
    svg = bar_chart(identity, bars, labels, wide=count == 1)
    return Chart(id=identity, title=title, svg=svg, alt=alt, columns=12 if count == 1 else 6)
