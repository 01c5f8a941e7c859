"""Sagittal curve distance: a trend within one person, never a score."""

from collections.abc import Sequence

from schemas.vocabulary import Side
from services.reference.curve_distance import VARIABLES
from services.report.catalogue import Catalogue
from services.report.content import Cell, Column, Row, Section, SectionId, Table
from services.report.phrases import joint_name
from services.report.sections import cells
from services.report.source import CurveDistance, ReportSource
from services.report.units import Measured

MOST_VISITS = 6
"""Newest visits shown."""


def curve_distance(source: ReportSource, words: Catalogue) -> Section | None:
    """None where no visit can be compared with the baseline's curves."""
    told = () if source.progress is None else source.progress.distances
    visits = sorted({each.visit for each in told})[-MOST_VISITS:]
    if not visits:
        return None
    by_visit = [[each for each in told if each.visit == visit] for visit in visits]
    measured = Measured(words, "rad", "curve_distance")
    title = words.text("title.curve_distance", count=len(VARIABLES))
    columns = [Column(head=words.text("column.measure"), side=None, numeric=False)]
    columns += [Column(head=f"{words.text('header.visit')} {visit}", side=None, numeric=True) for visit in visits]
    rows = [
        Row(
            head=joint_name(words, name),
            note=measured.symbol,
            cells=[_cell(words, measured, legs, name) for legs in by_visit],
        )
        for name in VARIABLES
        if any(name in each.by_variable for each in told)
    ]
    whole = [_cell(words, measured, legs, None) for legs in by_visit]
    rows.append(Row(head=words.text("column.all_four"), note=measured.symbol, cells=whole))
    return Section(
        id=SectionId.CURVE_DISTANCE, page=2, title=title, sentences=[], charts=[],
        table=Table(caption=title, columns=columns, rows=rows), notes=_notes(words, by_visit[-1]),
    )  # fmt: skip


def _cell(words: Catalogue, measured: Measured, legs: Sequence[CurveDistance], name: str | None) -> Cell:
    """`L 2.1, R 3.4`; of one variable, or of all four."""
    values = {each.side: each.distance if name is None else each.by_variable.get(name) for each in legs}
    texts: dict[Side | None, str] = {side: measured.bare(value) for side, value in values.items() if value is not None}
    return cells.sides_cell(words, texts)


def _notes(words: Catalogue, legs: Sequence[CurveDistance]) -> list[str]:
    seen = {name for each in legs for name in each.by_variable}
    missing = [joint_name(words, name).lower() for name in VARIABLES if name not in seen]
    notes = [words.text("note.curve_distance")]
    if missing:
        notes.append(words.text("note.curve_missing", joints=words.listed(missing)))
    return notes
