"""Progress: one small chart per measure, with baseline +- MDC, reference, and treatments as marks."""

from collections.abc import Sequence
from datetime import date

from schemas.vocabulary import Side
from services.progress.rules import Verdict
from services.report.catalogue import Catalogue
from services.report.charts.progress_chart import ProgressLabels, ProgressLine, TreatmentMark, VisitMark, progress_chart
from services.report.content import Chart, Section, SectionId
from services.report.source import MeasureProgress, Progress, ReportSource, Treatment, VisitValue
from services.report.units import Measured

MOST_CHARTS = 4
"""Small multiples on the page."""
CHOICE = (
    "six_minute_walk_distance", "ten_metre_walk_speed", "tug_time", "walking_speed", "step_length", "cadence",
    "stance_fraction", "knee_flexion_range", "stride_length", "repetition_range", "repetition_tempo",
    "repetition_knee_flexion_range", "tug_sit_to_stand_time", "tug_turn_time",
)  # fmt: skip
"""Which measures are drawn, the first that there are."""


def progress(source: ReportSource, words: Catalogue) -> Section | None:
    """None while there is one visit only."""
    told = source.progress
    if told is None:
        return None
    names = [name for name in CHOICE if any(_lines(told, name))][:MOST_CHARTS]
    names = [name for name in names if len({each.visit for h in _lines(told, name) for each in h.visits}) > 1]
    if not names:
        return None
    charts = [_chart(source, told, words, name) for name in names]
    notes = [_baseline_note(told, words)]
    if any(source.reference(name, side) for name in names for side in (None, *Side)):
        notes.append(words.text("note.progress_reference"))
    treatments = _treatments(told)
    if treatments:
        items = [
            f"{letter} {words.text(f'treatment.{each.kind}')} ({words.day(each.on)})"
            for letter, each in zip(_LETTERS, treatments, strict=False)
        ]
        notes.append(words.text("note.treatments", items=", ".join(items)))
    return Section(
        id=SectionId.PROGRESS, page=2, title=words.text("title.progress"), sentences=[], charts=charts, table=None,
        notes=notes,
    )  # fmt: skip


_LETTERS = "ABCDEFGHIJ"


def _lines(told: Progress, name: str) -> list[MeasureProgress]:
    return [each for each in told.measures if each.metric == name and each.visits]


def _baseline_note(told: Progress, words: Catalogue) -> str:
    if told.baseline_day is None:
        return words.text("note.no_baseline")
    return words.text("note.progress", baseline=words.day(told.baseline_day))


def _treatments(told: Progress) -> Sequence[Treatment]:
    return sorted(told.treatments, key=lambda each: each.on)[: len(_LETTERS)]


def _chart(source: ReportSource, told: Progress, words: Catalogue, name: str) -> Chart:
    histories = _lines(told, name)
    measured = Measured(words, histories[0].unit, name)
    factor = measured.how.factor
    lines = [_line(told, each, factor) for each in histories]
    reference = source.reference(name, histories[0].side)
    band = None if reference is None else (reference.low * factor, reference.high * factor)
    title = words.metric(name)
    alt = " ".join(_words_of(words, each, measured) for each in histories)
    labels = ProgressLabels(
        title=title,
        description=alt,
        y_axis=measured.symbol,
        x_axis=words.text("header.visit").lower(),
        letters={side: words.text(f"side.{side}_letter") for side in Side},
        decimal_mark=words.text("format.decimal_mark"),
    )
    identity = f"progress-{name.replace('_', '-')}"
    svg = progress_chart(identity, lines, band, _marks(told), labels)
    return Chart(id=identity, title=title, svg=svg, alt=alt, columns=3)


def _line(told: Progress, history: MeasureProgress, factor: float) -> ProgressLine:
    marks = [_mark(told, each, factor) for each in history.visits]
    baseline = None if history.baseline is None else history.baseline * factor
    return ProgressLine(history.side, marks, baseline, None if history.mdc is None else history.mdc * factor)


def _mark(told: Progress, value: VisitValue, factor: float) -> VisitMark:
    real = 0
    if value.verdict is Verdict.REAL_CHANGE and value.change is not None:
        real = 1 if value.change > 0 else -1
    low, high = (None if end is None else end * factor for end in (value.low, value.high))
    return VisitMark(value.visit, value.value * factor, low, high, value.visit == told.baseline_visit, real)


def _marks(told: Progress) -> list[TreatmentMark]:
    days = sorted({each.visit: each.day for history in told.measures for each in history.visits}.items())
    return [
        TreatmentMark(_between(each.on, days), letter)
        for letter, each in zip(_LETTERS, _treatments(told), strict=False)
    ]


def _between(on: date, days: Sequence[tuple[int, date]]) -> float:
    """Place of a date among the visits, by visit number."""
    before = [(visit, day) for visit, day in days if day <= on]
    after = [(visit, day) for visit, day in days if day > on]
    if not before:
        return days[0][0] - 0.3
    if not after:
        return days[-1][0] + 0.3
    (first, start), (second, end) = before[-1], after[0]
    return first + (second - first) * (on - start).days / (end - start).days


def _words_of(words: Catalogue, history: MeasureProgress, measured: Measured) -> str:
    points = "; ".join(
        words.text("chart.progress_alt_point", day=words.day(each.day), value=measured.full(each.value))
        for each in history.visits
    )
    band = "" if history.mdc is None else words.text("chart.progress_alt_band", mdc=measured.full(history.mdc))
    name = words.metric(history.metric)
    if history.side is not None:
        name = words.text("format.brackets", text=name, inside=words.text(f"side.{history.side}"))
    return words.text(
        "chart.progress_alt", name=name, points=points, baseline=measured.full(history.baseline), band=band
    )
