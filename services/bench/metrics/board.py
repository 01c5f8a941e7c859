"""`ambula bench metrics`: metrics, progress, report and exports, or some of them."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from rich.progress import Progress

from services.bench.metrics import coverage, exports, fhir, patients, report_pages, verdicts
from services.bench.report import Section, report_text, write_report
from services.bench.scoreboard import Row, Scoreboard
from services.ingest.errors import MissingFile

Advance = Callable[[], None]


class Part(NamedTuple):
    """One section of the scoreboard."""

    run: Callable[[Advance], Section]
    steps: int = 1
    """How often it advances."""


SECTIONS: dict[str, Part] = {
    "patients": Part(patients.patients_section, patients.STEPS),
    "coverage": Part(coverage.coverage_section, coverage.STEPS),
    "verdicts": Part(verdicts.verdicts_section, verdicts.STEPS),
    "report": Part(report_pages.report_section, report_pages.STEPS),
    "exports": Part(exports.run, exports.STEPS),
    "fhir": Part(fhir.fhir_section, fhir.STEPS),
}
"""By the name that `ambula bench metrics NAME` takes, in the order of the report."""
HOW_TO_READ = """What a physiotherapist is told, against what is known. Everything comes from `ambula bench metrics`;
numbers follow from seeds and recordings alone, run times from this machine."""


def run(json_path: Path | None = None, *names: str, report: Path | None = None) -> Scoreboard:
    """Score some of SECTIONS, or all; with `report` also write report.md and its charts into that folder.

    Raises:
        ValueError: the section is not known.
        MissingFile: the data of a section that was asked for are not there; asked for all, its rows say so.
    """
    unknown = [name for name in names if name not in SECTIONS]
    if unknown:
        raise ValueError(f"metrics has the sections {', '.join(SECTIONS)}, not {', '.join(unknown)}")
    chosen = names or tuple(SECTIONS)
    with Progress(transient=True) as progress:
        bar = progress.add_task("metrics", total=sum(SECTIONS[name].steps for name in chosen))
        sections = [_section(name, lambda: progress.advance(bar), skip=not names) for name in chosen]
    board = _board(names, sections)
    if json_path is not None:
        board.write_json(json_path)
    if report is not None:
        write_report(report, report_text(board.title, [HOW_TO_READ, ""], sections), sections)
    return board


def _board(names: tuple[str, ...], sections: list[Section]) -> Scoreboard:
    notes = dict.fromkeys(paragraph for section in sections for paragraph in section.paragraphs)
    return Scoreboard(
        f"metrics: {', '.join(names)}" if names else "metrics",
        [row for section in sections for row in section.rows],
        "\n".join(notes),
        [table for section in sections for table in section.tables],
    )


def _section(name: str, advance: Advance, *, skip: bool) -> Section:
    try:
        return SECTIONS[name].run(advance)
    except MissingFile as error:
        if not skip:
            raise
        return Section(name, [str(error)], [Row(name, None, "", str(error), None, None)])
