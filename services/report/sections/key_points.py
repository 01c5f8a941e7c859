"""Key points of the joint angles: left, right, difference."""

from schemas.metrics import Metric
from schemas.vocabulary import Side
from services.report.catalogue import Catalogue
from services.report.content import Cell, Column, Row, Section, SectionId, Table
from services.report.sections import cells
from services.report.source import ReportSource
from services.report.units import Measured

ROWS = (
    "knee_flexion_at_contact", "knee_flexion_smallest_stance", "knee_flexion_peak_swing", "knee_flexion_range",
    "hip_flexion_at_contact", "hip_extension_peak", "hip_flexion_range", "ankle_dorsiflexion_at_contact",
    "ankle_dorsiflexion_peak_swing", "hip_rotation_range", "circumduction",
)  # fmt: skip


def key_points(source: ReportSource, words: Catalogue) -> Section | None:
    """None where no joint was seen."""
    rows = [row for name in ROWS if (row := _row(source, words, name)) is not None]
    if not rows:
        return None
    title = words.text("title.key_points")
    columns = [Column(head=words.text("column.measure"), side=None, numeric=False)]
    columns += [Column(head=words.text(f"column.{side}"), side=side, numeric=True) for side in Side]
    columns.append(Column(head=words.text("column.difference"), side=None, numeric=True))
    return Section(
        id=SectionId.KEY_POINTS, page=2, title=title, sentences=[], charts=[],
        table=Table(caption=title, columns=columns, rows=rows), notes=[],
    )  # fmt: skip


def _row(source: ReportSource, words: Catalogue, name: str) -> Row | None:
    left, right = source.metric(name, Side.LEFT), source.metric(name, Side.RIGHT)
    given = [metric for metric in (left, right) if metric is not None and metric.value is not None]
    if not given:
        return None
    measured = Measured.of(words, given[0])
    fields = [cells.metric_cell(words, left), cells.metric_cell(words, right), _difference(measured, left, right)]
    return Row(head=words.metric(name), note=measured.symbol, cells=fields)


def _difference(measured: Measured, left: Metric | None, right: Metric | None) -> Cell:
    if left is None or right is None or left.value is None or right.value is None:
        return cells.EMPTY
    return cells.plain(measured.bare(left.value - right.value, signed=True))
