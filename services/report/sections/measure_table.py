"""The table of measures: Left | Right | Reference | against reference | change since baseline | MDC."""

from collections.abc import Sequence

from schemas.metrics import DoubtKind, Metric
from schemas.vocabulary import Side
from services.report.catalogue import Catalogue
from services.report.content import Cell, Column, Row, Table
from services.report.sections import cells
from services.report.source import MeasureProgress, ReportSource, VisitValue
from services.report.units import Measured

SIDES = (Side.LEFT, Side.RIGHT)


def measure_table(source: ReportSource, words: Catalogue, names: Sequence[str], caption: str) -> Table | None:
    """A row for each metric that the session has; None where it has none of them.

    The columns of references and of changes are there where at least one row fills them.
    """
    rows = [row for name in names if (row := _row(source, words, name)) is not None]
    if not rows:
        return None
    heads = ("reference", "against", "change", "mdc")
    kept = [index for index in range(len(heads)) if any(extra[index] is not cells.EMPTY for _, _, extra in rows)]
    sided = any(len(values) > 1 for _, values, _ in rows)
    columns = [_column(words, "measure", numeric=False)]
    columns += [_column(words, side, side=side) for side in SIDES] if sided else [_column(words, "value")]
    columns += [_column(words, heads[index]) for index in kept]
    drawn = []
    for head, values, extra in rows:
        wide = 2 if sided and len(values) == 1 else 1
        spanned = [cell.model_copy(update={"span": wide}) for cell in values]
        drawn.append(head.model_copy(update={"cells": [*spanned, *(extra[index] for index in kept)]}))
    return Table(caption=caption, columns=columns, rows=drawn)


def _column(words: Catalogue, name: str, *, side: Side | None = None, numeric: bool = True) -> Column:
    return Column(head=words.text(f"column.{name}"), side=side, numeric=numeric)


def _row(source: ReportSource, words: Catalogue, name: str) -> tuple[Row, list[Cell], list[Cell]] | None:
    found = [metric for metric in source.metrics.metrics if metric.name == name]
    if not found or not any(_is_seen(metric) for metric in found):
        return None
    measured = Measured.of(words, found[0])
    by_side = {_side(metric): metric for metric in found}
    values = [cells.metric_cell(words, by_side.get(side)) for side in SIDES]
    if None in by_side:
        values = [cells.metric_cell(words, by_side[None])]
    extra = [
        _reference(source, words, measured, by_side),
        _against(source, words, by_side),
        _change(source, words, measured, by_side),
        _mdc(source, words, measured, by_side),
    ]
    return Row(head=words.metric(name), note=measured.symbol or None, cells=[]), values, extra


def _is_seen(metric: Metric) -> bool:
    told = [doubt.kind for doubt in metric.doubts]
    return metric.value is not None or metric.strides > 0 or (bool(told) and DoubtKind.NOT_OBSERVED not in told)


def _side(metric: Metric) -> Side | None:
    return None if metric.side is None else Side(metric.side)


def _reference(source: ReportSource, words: Catalogue, measured: Measured, metrics: dict[Side | None, Metric]) -> Cell:
    name = next(iter(metrics.values())).name
    found = [reference for side in metrics if (reference := source.reference(name, side)) is not None]
    return cells.reference_cell(words, measured, found[0]) if found else cells.EMPTY


def _against(source: ReportSource, words: Catalogue, metrics: dict[Side | None, Metric]) -> Cell:
    texts = {}
    for side, metric in metrics.items():
        reference = source.reference(metric.name, side)
        if reference is not None and metric.value is not None:
            texts[side] = words.text(f"place.{cells.place(metric.value, reference)}")
    return cells.sides_cell(words, texts)


def _change(source: ReportSource, words: Catalogue, measured: Measured, metrics: dict[Side | None, Metric]) -> Cell:
    changes: dict[Side | None, VisitValue] = {}
    for side, metric in metrics.items():
        now = current(source, source.history(metric.name, side))
        if now is not None and now.change is not None:
            changes[side] = now
    texts = {side: cells.change_text(measured, value) for side, value in changes.items()}
    verdicts = {side: cells.verdict_word(words, value.verdict) for side, value in changes.items()}
    return cells.sides_cell(words, texts, lambda: cells.by_side(words, verdicts))


def current(source: ReportSource, history: MeasureProgress | None) -> VisitValue | None:
    """What a measure was at the visit that is reported; None where it has no value, or the visit is the baseline."""
    if history is None or source.progress is None or source.progress.visit == source.progress.baseline_visit:
        return None
    return next((each for each in history.visits if each.visit == source.progress.visit), None)


def _mdc(source: ReportSource, words: Catalogue, measured: Measured, metrics: dict[Side | None, Metric]) -> Cell:
    texts = {}
    for side, metric in metrics.items():
        text = cells.mdc_text(measured, source.history(metric.name, side))
        if text is not None:
            texts[side] = text
    return cells.sides_cell(words, texts)
