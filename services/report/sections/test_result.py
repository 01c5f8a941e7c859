"""The result of a timed test: its numbers as a table, its phases as a drawing."""

from schemas.vocabulary import Task
from services.report.catalogue import Catalogue
from services.report.charts.bar_chart import Bar, BarLabels, bar_chart
from services.report.charts.phase_chart import PhasePart, phase_chart
from services.report.content import Chart, Section, SectionId
from services.report.sections.measure_table import measure_table
from services.report.sections.table_notes import table_notes
from services.report.source import ReportSource
from services.report.units import Measured

PREFIXES: dict[Task, str] = {
    Task.TIMED_UP_AND_GO: "tug_",
    Task.SIX_MINUTE_WALK: "six_minute_walk_",
    Task.TEN_METRE_WALK: "ten_metre_walk_",
    Task.MARCHING: "marching_",
}
"""What the names of a test's own metrics begin with."""
MINUTES = ("first", "second", "third", "fourth", "fifth", "sixth")
"""Minutes of a six-minute walk, whose speeds are drawn instead of listed."""
LEAST_MINUTES = 2
"""Minutes from which on a drawing tells more than the table."""
MOST_ROWS = 3
"""Attempts drawn at most."""


def test_result(source: ReportSource, words: Catalogue) -> Section | None:
    """None for a task that is no timed test, or that was not seen at all."""
    prefix = PREFIXES.get(source.description.task)
    if prefix is None:
        return None
    drawn = [_minute_speed(minute) for minute in MINUTES]
    found = [each.name for each in source.metrics.metrics if each.name.startswith(prefix) and each.name not in drawn]
    names = list(dict.fromkeys(found))
    title = words.text("title.test_section")
    table = measure_table(source, words, names, title)
    phases = _phases(source, words)
    charts = [*_minutes(source, words), *phases]
    if table is None and not charts:
        return None
    notes = table_notes(source, words, names) + ([words.text("note.phase_order")] if phases else [])
    return Section(id=SectionId.TEST, page=1, title=title, sentences=[], charts=charts, table=table, notes=notes)


def _minute_speed(minute: str) -> str:
    return f"six_minute_walk_speed_{minute}_minute"


def _minutes(source: ReportSource, words: Catalogue) -> list[Chart]:
    """Speed minute by minute; nothing where it was told of one minute only."""
    values = [source.value(_minute_speed(minute)) for minute in MINUTES]
    told = [value for value in values if value is not None]
    if len(told) < LEAST_MINUTES:
        return []
    title = words.text("title.minutes")
    speed = Measured(words, "m/s", "walking_speed")
    parts = ", ".join(f"{number}: {speed.full(value)}" for number, value in enumerate(told, start=1))
    alt = words.text("chart.minutes_alt", parts=parts)
    labels = BarLabels(title, alt, words.text("chart.minute_axis"), speed.symbol, words.text("format.decimal_mark"))
    svg = bar_chart("minutes", [Bar(None, value, True) for value in told], labels)
    return [Chart(id="minutes", title=title, svg=svg, alt=alt, columns=6)]


def _phases(source: ReportSource, words: Catalogue) -> list[Chart]:
    """One line for each attempt."""
    attempts: dict[int, list[PhasePart]] = {}
    seconds = Measured(words, "s", "time")
    for phase in source.metrics.phases:
        if phase.end_ns is None:
            continue
        name = words.text(f"phase.{phase.phase}")
        length = (phase.end_ns - phase.start_ns) / 1e9
        part = PhasePart(str(phase.phase), name, phase.start_ns / 1e9, length, seconds.full(length))
        attempts.setdefault(phase.attempt, []).append(part)
    shown = list(attempts.values())[:MOST_ROWS]
    if not shown:
        return []
    title = words.text("title.phases")
    parts = ", ".join(words.text("chart.phases_part", name=p.name, value=p.text) for row in shown for p in row)
    alt = words.text("chart.phases_alt", parts=parts)
    heads = [words.text("column.attempt", number=number + 1) for number in range(len(shown))]
    svg = phase_chart("phases", title, alt, list(zip(heads, shown, strict=True)))
    return [Chart(id="phases", title=title, svg=svg, alt=alt, columns=12)]
