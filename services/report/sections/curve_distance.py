"""Sagittal curve distance: a trend within one person, never a score."""

from services.reference.curve_distance import VARIABLES
from services.report.catalogue import Catalogue
from services.report.content import Cell, Column, Row, Section, SectionId, Table
from services.report.phrases import joint_name
from services.report.sections import cells
from services.report.source import ReportSource
from services.report.units import Measured

MOST_VISITS = 6
"""Newest visits shown."""


def curve_distance(source: ReportSource, words: Catalogue) -> Section | None:
    """None where no visit can be compared with the baseline's curves."""
    distances = () if source.progress is None else source.progress.distances[-MOST_VISITS:]
    if not distances:
        return None
    measured = Measured(words, "rad", "curve_distance")
    title = words.text("title.curve_distance", count=len(VARIABLES))
    columns = [Column(head=words.text("column.measure"), side=None, numeric=False)]
    columns += [
        Column(head=f"{words.text('header.visit')} {each.visit}", side=None, numeric=True) for each in distances
    ]
    rows = [
        Row(
            head=joint_name(words, name),
            note=measured.symbol,
            cells=[_cell(measured, each.by_variable.get(name)) for each in distances],
        )
        for name in VARIABLES
        if any(name in each.by_variable for each in distances)
    ]
    whole = [_cell(measured, each.distance) for each in distances]
    rows.append(Row(head=words.text("column.all_four"), note=measured.symbol, cells=whole))
    missing = [joint_name(words, name).lower() for name in VARIABLES if name not in distances[-1].by_variable]
    notes = [words.text("note.curve_distance")]
    if missing:
        notes.append(words.text("note.curve_missing", joints=words.listed(missing)))
    return Section(
        id=SectionId.CURVE_DISTANCE, page=2, title=title, sentences=[], charts=[],
        table=Table(caption=title, columns=columns, rows=rows), notes=notes,
    )  # fmt: skip


def _cell(measured: Measured, value: float | None) -> Cell:
    return cells.EMPTY if value is None else cells.plain(measured.bare(value))
