"""`ambula bench knee`: one subject or all, with a report on demand."""

from collections.abc import Callable
from pathlib import Path

from rich.progress import Progress

from services.bench.knee import (
    axis_board,
    chain_board,
    grover_board,
    hinge_board,
    kam_board,
    soft_tissue_board,
    trust_board,
    walk_limits,
    worn_board,
)
from services.bench.report import Section, report_text, write_report
from services.bench.scoreboard import Row, Scoreboard
from services.ingest.errors import SourceError

SUBJECTS: dict[str, Callable[[Progress], Section]] = {
    "weygers": hinge_board.hinge_section,
    "fan": worn_board.fan_section,
    "alborno": worn_board.alborno_section,
    "neura": worn_board.neura_section,
    "limits": walk_limits.limits_section,
    "kam": kam_board.kam_section,
    "axis": axis_board.axis_section,
    "grover": grover_board.grover_section,
    "soft_tissue": soft_tissue_board.soft_tissue_section,
    "trust": trust_board.trust_section,
    "service": chain_board.chain_section,
}
HOW_TO_READ = """Two sensors, one knee. Beside ours stand the two published methods as they were written (McGrath,
Fineman and Stirling 2018; Grover and Natarajan) and kept libraries on the same samples. Everything comes from
`ambula bench knee`; numbers follow from seeds and recordings alone, run times from this machine. Errors are those of
knee flexion in degrees: absolute (eq. 4b of McGrath), or zero-mean, which is offset-removed (eq. 4c)."""


def run(json_path: Path | None = None, subject: str | None = None, *, report: Path | None = None) -> Scoreboard:
    """Score one of SUBJECTS, or all; with `report` also write report.md and its charts into that folder.

    Raises:
        ValueError: the subject is not known.
        MissingFile: the data of the one subject asked for are not there; asked for all, its rows say so.
    """
    if subject is not None and subject not in SUBJECTS:
        raise ValueError(f"knee is measured on {', '.join(SUBJECTS)}, not on {subject!r}")
    with Progress(transient=True) as progress:
        names = [subject] if subject is not None else list(SUBJECTS)
        sections = [_section(name, progress, skip=subject is None) for name in names]
    title = f"knee on {subject}" if subject else "knee"
    note = "\n\n".join("\n".join(section.paragraphs) for section in sections)
    board = Scoreboard(title, [row for section in sections for row in section.rows], note)
    if json_path is not None:
        board.write_json(json_path)
    if report is not None:
        write_report(report, report_text(title, [HOW_TO_READ, ""], sections), sections)
    return board


def _section(name: str, progress: Progress, *, skip: bool) -> Section:
    try:
        return SUBJECTS[name](progress)
    except SourceError as error:
        if not skip:
            raise
        return Section(name, [str(error)], [Row(name, None, "", str(error), None, None)])
