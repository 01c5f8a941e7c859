"""The scoreboard of the Rhythmic EKF as a folder: report.md, its charts, every row."""

import re
from collections.abc import Sequence
from pathlib import Path

from services.bench.joukov.sections import Section, Table
from services.bench.scoreboard import Row

HOW_TO_READ = """The Rhythmic EKF of Joukov et al. learns a periodic movement while it is estimated and tells the filter
which jerk comes next. Here its experiments are repeated on many motions, with truth, and beside it stand the plain EKF
and our version of it. Everything comes from `ambula bench joukov`; numbers follow from seeds and recordings alone.

**S** is the process noise of the filters: the variance of the jerk of one sample of 10 ms, (rad/s³)². What a rhythm
adds depends on it more than on anything else. With a small S the plain filter trusts its constant acceleration and
lags, and a model of the movement helps much; with a large S the filter follows its sensors anyway. **S*** is a tuning
for the plain filter's angles; each section says on what it was found. **S*/10** is the lag-limited filter at which the
published improvements appear."""


def write_report(folder: Path, title: str, sections: Sequence[Section]) -> None:
    """Write report.md and SVG files into `folder`, which is made if need be."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = [f"# {title}", "", HOW_TO_READ, "", *_findings(sections), *_summary(sections)]
    for place, section in enumerate(sections, 1):
        for name, svg in section.charts.items():
            (folder / f"{name}.svg").write_text(svg, encoding="utf-8")
        lines += ["", f"## {place}. {section.title}", "", *_section(section)]
    # The star of S* would begin an emphasis; the bold S is left alone.
    text = re.sub(r"S\*(?!\*(?!\*))", r"S\\*", "\n".join(lines))
    (folder / "report.md").write_text(text + "\n", encoding="utf-8")


def _findings(sections: Sequence[Section]) -> list[str]:
    """The published figures and what became of them."""
    findings = [finding for section in sections for finding in section.findings]
    table = Table(
        "Change of the RMSE against the plain EKF at the same S",
        ("published", "here", "S at which the published gain appears"),
        findings,
    )
    return ["## What the paper reports, and under which S it appears", "", *table.markdown(), ""] if findings else []


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
        name = row.name.replace("|", "\\|")
        value, baseline = (_number(number) for number in (row.value, row.baseline))
        lines.append(f"| {name} | {value} | {row.unit} | {row.target or ''} | {marks[row.met]} | {baseline} |")
    return lines


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}"
