"""`ambula bench kinect`: simulated tasks, recordings and cost, or one of them."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import NamedTuple

from rich.progress import Progress

from services.bench.kinect import (
    cost_section,
    fusion_section,
    recorded_section,
    simulated_section,
    spm_section,
    table_section,
    walking_section,
)
from services.bench.report import Section, Table, report_text, write_report
from services.bench.scoreboard import Row, Scoreboard
from services.ingest.errors import MissingFile

Advance = Callable[[], None]


class Part(NamedTuple):
    """One subject of the scoreboard."""

    run: Callable[[Advance], Section]
    steps: int
    """How often it advances."""


def _plain(title: str, rows: Callable[[], list[Row]], note: str = "") -> Part:
    def run(advance: Advance) -> Section:
        found = rows()
        advance()
        return Section(title, [note] if note else [], found)

    return Part(run, 1)


def _advancing(title: str, rows: Callable[[Advance], list[Row]], steps: int, note: str = "") -> Part:
    return Part(lambda advance: Section(title, [note] if note else [], rows(advance)), steps)


SECTIONS: dict[str, Part] = {
    "table": Part(table_section.table_section, table_section.STEPS),
    "parts": _advancing("parts of ours", simulated_section.parts_rows, simulated_section.STEPS, simulated_section.NOTE),
    "ours": _advancing("ours", simulated_section.our_rows, simulated_section.TRIALS, simulated_section.NOTE),
    "paper": _advancing(
        "ours, offsets as of the paper's camera",
        partial(simulated_section.our_rows, kind="paper"),
        simulated_section.TRIALS,
        simulated_section.NOTE,
    ),
    "spm": Part(spm_section.spm_section, spm_section.STEPS),
    "kimore": _plain("KIMORE", recorded_section.kimore_rows, recorded_section.NOTE),
    "keraal": _plain("KERAAL", recorded_section.keraal_rows),
    "walking": _advancing("walking", walking_section.walking_rows, walking_section.STEPS, walking_section.NOTE),
    "fusion": _advancing("fusion", fusion_section.fusion_rows, len(fusion_section.SEEDS), fusion_section.NOTE),
    "cost": _plain("cost", cost_section.cost_rows, cost_section.NOTE),
}
"""By the name that `ambula bench kinect table` takes."""

WHOLE = ("table", "parts", "spm", "kimore", "keraal", "walking", "fusion", "cost")
"""What runs without a word; `ours` and `paper` are the parts of `table` that take some seconds."""
HOW_TO_READ = """The whole body from a depth camera. Beside ours stand the filter of Colombel et al. (2020), as printed
and put right, and the fit of each frame. Everything comes from `ambula bench kinect`; numbers follow from seeds and
recordings alone, run times from this machine. Errors are those of joint angles in degrees."""


def run(json_path: Path | None = None, *subjects: str, report: Path | None = None) -> Scoreboard:
    """Score some of SECTIONS, or all; with `report` also write report.md and its charts into that folder.

    Raises:
        ValueError: the section is not known.
        MissingFile: the data of a section that was asked for are not there; asked for all, its rows say so.
    """
    unknown = [subject for subject in subjects if subject not in SECTIONS]
    if unknown:
        raise ValueError(f"kinect is measured on {', '.join(SECTIONS)}, not on {', '.join(unknown)}")
    names = subjects or WHOLE
    with Progress(transient=True) as progress:
        bar = progress.add_task("trials", total=sum(SECTIONS[name].steps for name in names))
        sections = [_section(name, lambda: progress.advance(bar), skip=not subjects) for name in names]
    title = f"kinect: {', '.join(subjects)}" if subjects else "kinect"
    notes = dict.fromkeys(paragraph for section in sections for paragraph in section.paragraphs)
    rows = [row for section in sections for row in section.rows]
    board = Scoreboard(title, rows, "\n".join(notes), [grid for section in sections for grid in _grids(section)])
    if json_path is not None:
        board.write_json(json_path)
    if report is not None:
        write_report(report, report_text(title, [HOW_TO_READ, ""], sections), sections)
    return board


def _grids(section: Section) -> list[Table]:
    """What of its tables is for the terminal."""
    return table_section.shown(section.tables)


def _section(name: str, advance: Advance, *, skip: bool) -> Section:
    try:
        return SECTIONS[name].run(advance)
    except MissingFile as error:
        if not skip:
            raise
        return Section(name, [str(error)], [Row(name, None, "", str(error), None, None)])
