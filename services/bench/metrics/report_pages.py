"""The report: how long its PDF takes, whether it is the same everywhere, and whether everybody can read it."""

import hashlib
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from services.bench.metrics.report_patient import WALKS, Visited, report_of, report_of_last
from services.bench.metrics.report_pdf import Printed, printed
from services.bench.report import Section, Table
from services.bench.scoreboard import Row, at_least, at_most, informative
from services.report.assemble import make_report
from services.report.catalogue import catalogue
from services.report.charts.colours import TEXT_COLOURS, TEXT_ON, contrast
from services.report.content import Language, Report
from services.report.press import Press
from services.report.source import ReportSource

LIMIT_S = 0.3
LEAST_CONTRAST = 4.5
REPEATS, FIRST_REPEATS = 20, 5
OTHERS = {
    "timed up and go": "synthetic:tug?attempts=2&stroll=8&seed=4",
    "knee exercise": "synthetic:knee?seed=2&duration=60",
    "squats": "synthetic:squat?person=2&repetitions=8",
    "one-minute walk": "synthetic:six_minutes?duration=60&corridor=10&seed=6",
    "ten-metre walk": "synthetic:ten_metres?seed=7",
}
"""Sources of the other kinds of report, by name."""
STEPS = len(WALKS) + len(OTHERS)
NOTE = (
    "report: a synthetic patient with a stroke at four visits, and one session of each other kind, through the whole "
    "chain, in every language. Warm: a compiler that has printed before, each time another report. Identical: the same "
    "report printed by two fresh processes and by this one. Contrast by WCAG, of every colour that text has in the PDF."
)
ALONE = """
import hashlib, sys, time
from services.report.content import Report
start, worked = time.perf_counter(), time.process_time()
from services.report.press import Press
report = Report.model_validate_json(sys.stdin.read())
pdf = Press().pdf(report)
print(time.perf_counter() - start, time.process_time() - worked, hashlib.sha256(pdf).hexdigest())
"""


def report_section(advance: Callable[[], None]) -> Section:
    """All of it."""
    sources = _sources(advance)
    press = Press()
    reports = {
        (kind, language): make_report(source, language) for kind, source in sources.items() for language in Language
    }
    pdfs = {key: press.pdf(report) for key, report in reports.items()}
    papers = {key: printed(pdf) for key, pdf in pdfs.items()}
    walk = reports["walk", Language.ENGLISH]
    rows = [*_times(press, sources["walk"], walk), *_sameness(walk, pdfs["walk", Language.ENGLISH])]
    rows += [*_reading(list(reports.values()), list(papers.values())), *_words()]
    return Section("the report on two pages", [NOTE], rows, [_table(reports, pdfs, papers)])


def _sources(advance: Callable[[], None]) -> dict[str, ReportSource]:
    visited = []
    for number, spec in enumerate(WALKS):
        visited.append(Visited(spec, number))
        advance()
    sources = {"walk": report_of_last(visited)}
    for kind, spec in OTHERS.items():
        sources[kind] = report_of(Visited(spec, 0))
        advance()
    return sources


def _times(press: Press, source: ReportSource, walk: Report) -> list[Row]:
    content, pdf = [], []
    for number in range(REPEATS):
        start = time.perf_counter()
        report = make_report(replace(source, recording_sha256=f"{number:064x}"), Language.ENGLISH)
        made = time.perf_counter()
        press.pdf(report)
        pdf.append(time.perf_counter() - made)
        content.append(made - start)
    alone = [_alone(walk) for _ in range(FIRST_REPEATS)]
    return [
        at_most(
            "report: PDF, first of a process, compiler and fonts included, best of 5",
            min(each.wall_s for each in alone),
            "s",
            LIMIT_S,
        ),
        informative("report: the same in time of the processors, all threads", min(each.cpu_s for each in alone), "s"),
        at_most("report: PDF, warm, median", statistics.median(pdf), "s", LIMIT_S),
        informative("report: PDF, warm, slowest of 20", max(pdf), "s"),
        informative("report: content from stored values, median", statistics.median(content), "s"),
    ]


def _sameness(walk: Report, pdf: bytes) -> list[Row]:
    digests = {hashlib.sha256(pdf).hexdigest(), *(_alone(walk).digest for _ in range(2))}
    return [at_most("report: different PDFs of one report, three processes", len(digests), "", 1)]


class Alone(NamedTuple):
    """What a fresh process took, and the digest of what it printed."""

    wall_s: float
    cpu_s: float
    digest: str


def _alone(report: Report) -> Alone:
    told = subprocess.run(
        [sys.executable, "-c", ALONE], input=report.model_dump_json(), capture_output=True, text=True, check=True
    ).stdout.split()
    return Alone(float(told[0]), float(told[1]), told[2])


def _reading(reports: list[Report], papers: list[Printed]) -> list[Row]:
    """Tags, words and contrast of all documents together."""
    whole = sum(
        paper.tagged and paper.ua and paper.language == report.language and bool(paper.title)
        for report, paper in zip(reports, papers, strict=True)
    )
    figures = sum(paper.kinds.get("Figure", 0) for paper in papers)
    drawn = sum(len(section.charts) for report in reports for section in report.sections)
    tables = sum(paper.kinds.get("Table", 0) for paper in papers)
    written = sum(section.table is not None for report in reports for section in report.sections)
    used = {colour for paper in papers for colour in paper.text_colours}
    checked = [contrast(TEXT_COLOURS[name], ground) for ground, names in TEXT_ON.items() for name in names]
    return [
        at_least("report: PDF/UA-1 with tags, title and language", 100 * whole / len(papers), "%", 100.0),
        at_most("report: figures without words", sum(paper.figures_without_words for paper in papers), "", 0),
        at_most("report: charts and tables that are not tagged", drawn + written - figures - tables, "", 0),
        at_most("report: pages of the longest", max(paper.pages for paper in papers), "", 2),
        at_least(
            "report: least contrast of text in the PDFs on white",
            min(contrast(c, "#FFFFFF") for c in used),
            ":1",
            LEAST_CONTRAST,
        ),
        at_least("report: least contrast of text by source colours and grounds", min(checked), ":1", LEAST_CONTRAST),
        at_most("report: text colours in the PDFs that are in no table", len(used - _known()), "", 0),
    ]


def _known() -> set[str]:
    return {colour.upper() for colour in TEXT_COLOURS.values()}


def _words() -> list[Row]:
    keys = [catalogue(language).messages.keys() for language in Language]
    lacking = len(set().union(*keys)) - len(set(keys[0]).intersection(*keys))
    return [
        at_least("report: languages", len(Language), "", 2),
        at_most("report: messages that a language lacks", lacking, "", 0),
    ]


def _table(
    reports: dict[tuple[str, Language], Report], pdfs: dict[tuple[str, Language], bytes],
    papers: dict[tuple[str, Language], Printed],
) -> Table:  # fmt: skip
    header = ("report", "pages", "kB", "sections", "charts", "tables", "sentences of the summary")
    lines = []
    for (kind, language), report in reports.items():
        key = (kind, language)
        charts = sum(len(each.charts) for each in report.sections)
        tables = sum(each.table is not None for each in report.sections)
        counts = (papers[key].pages, round(len(pdfs[key]) / 1e3), len(report.sections), charts, tables)
        lines.append((f"{kind}, {language}", *map(str, counts), str(len(report.sections[0].sentences))))
    return Table("reports", header, lines)
