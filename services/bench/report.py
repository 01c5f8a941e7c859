"""Scoreboards as a folder: report.md, its charts, every row."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from services.bench.scoreboard import Row


@dataclass(frozen=True)
class Table:
    """A table of text."""

    caption: str
    header: Sequence[str]
    rows: Sequence[Sequence[str]]

    def markdown(self) -> list[str]:
        """Lines; the first column is aligned left, the others right."""
        ruler = ["---", *("--:" for _ in self.header[1:])]
        lines = [self.header, ruler, *self.rows]
        return [f"**{self.caption}**", "", *(f"| {' | '.join(_cell(c) for c in line)} |" for line in lines)]


@dataclass(frozen=True)
class Section:
    """One experiment."""

    title: str
    paragraphs: Sequence[str]
    """What was done; which parameters were chosen on what and scored on what."""
    rows: Sequence[Row]
    tables: Sequence[Table] = ()
    charts: dict[str, str] = field(default_factory=dict)
    """SVG by file name without its ending."""


def number(value: float) -> str:
    """About three digits, for a table."""
    if not np.isfinite(value):
        return "-"
    decimals = 0 if abs(value) >= 100 else 1 if abs(value) >= 10 else 2
    return f"{value:.{decimals}f}"


def report_text(title: str, introduction: Sequence[str], sections: Sequence[Section]) -> str:
    """The Markdown: introduction lines, what has a target, then every section."""
    lines = [f"# {title}", "", *introduction, *_summary(sections)]
    for place, section in enumerate(sections, 1):
        lines += ["", f"## {place}. {section.title}", "", *_section(section)]
    return "\n".join(lines) + "\n"


def write_report(folder: Path, text: str, sections: Sequence[Section]) -> None:
    """Write report.md and the charts of the sections into `folder`, which is made if need be."""
    folder.mkdir(parents=True, exist_ok=True)
    for section in sections:
        for name, svg in section.charts.items():
            (folder / f"{name}.svg").write_text(svg, encoding="utf-8")
    (folder / "report.md").write_text(text, encoding="utf-8")


def _summary(sections: Sequence[Section]) -> list[str]:
    """What has a target."""
    rows = [row for section in sections for row in section.rows if row.met is not None]
    missed = sum(row.met is False for row in rows)
    return [f"## Targets: {len(rows) - missed} of {len(rows)} met", "", *_table(rows)] if rows else []


def _section(section: Section) -> list[str]:
    lines = [line for paragraph in section.paragraphs for line in (paragraph, "")]
    for name in section.charts:
        lines += [f"![{name.replace('_', ' ')}]({name}.svg)", ""]
    for table in section.tables:
        lines += [*table.markdown(), ""]
    main, details = ([row for row in section.rows if row.detail is detail] for detail in (False, True))
    lines += ["### Figures", "", *_table(main)]
    if details:
        lines += ["", "<details><summary>every row</summary>", "", *_table(details), "", "</details>"]
    return lines


def _table(rows: Sequence[Row]) -> list[str]:
    lines = ["| figure | value | unit | target | | baseline |", "|---|--:|---|---|---|--:|"]
    marks = {None: "", True: "met", False: "**missed**"}
    for row in rows:
        name = _cell(row.name)
        value, baseline = (_number(value) for value in (row.value, row.baseline))
        lines.append(f"| {name} | {value} | {row.unit} | {row.target or ''} | {marks[row.met]} | {baseline} |")
    return lines


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
