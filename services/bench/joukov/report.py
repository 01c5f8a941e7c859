"""The report of the Rhythmic EKF: how to read it, what was published, every section."""

import re
from collections.abc import Sequence
from pathlib import Path

from services.bench import report
from services.bench.joukov.sections import Section

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
    text = report.report_text(title, [HOW_TO_READ, "", *_findings(sections)], sections)
    # The star of S* would begin an emphasis; the bold S is left alone.
    report.write_report(folder, re.sub(r"S\*(?!\*(?!\*))", r"S\\*", text), sections)


def _findings(sections: Sequence[Section]) -> list[str]:
    """The published figures and what became of them."""
    findings = [finding for section in sections for finding in section.findings]
    table = report.Table(
        "Change of the RMSE against the plain EKF at the same S",
        ("published", "here", "S at which the published gain appears"),
        findings,
    )
    return ["## What the paper reports, and under which S it appears", "", *table.markdown(), ""] if findings else []
