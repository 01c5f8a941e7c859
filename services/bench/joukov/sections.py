"""One experiment of the report: what was done, its figures, tables and charts."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from services.bench.scoreboard import Row

COLOURS = {
    "truth": "#222222",
    "EKF": "#d98c1f",
    "literal": "#8e5ea2",
    "ours": "#1f6fb2",
    "ours, adaptive noise": "#2e8b57",
    "ours, as for walking": "#8fc1e8",
    "literal, velocity": "#c9a3d4",
    "literal, acceleration": "#8e5ea2",
    "ours, position": "#9aa5ab",
    "ours, velocity": "#7db8e8",
    "ours, acceleration": "#1f6fb2",
}
"""Of what is drawn in several charts."""


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


class Finding(NamedTuple):
    """A figure that the paper reports, and what became of it."""

    published: str
    here: str
    S: str
    """Under which S."""


@dataclass(frozen=True)
class Section:
    """One experiment."""

    title: str
    paragraphs: Sequence[str]
    """What was done; which parameters were chosen on what and scored on what; under which S."""
    rows: Sequence[Row]
    tables: Sequence[Table] = ()
    charts: dict[str, str] = field(default_factory=dict)
    """SVG by file name without its ending."""
    findings: Sequence[Finding] = ()


def number(value: float) -> str:
    """About three digits, for a table."""
    if not np.isfinite(value):
        return "-"
    decimals = 0 if abs(value) >= 100 else 1 if abs(value) >= 10 else 2
    return f"{value:.{decimals}f}"


def up_to(S: float | None) -> str:
    """The largest S at which something holds, in words."""
    return "at no S tried" if S is None else f"up to {power(S)}"


def power(S: float) -> str:
    """S as a power of ten, for a table."""
    mantissa, exponent = f"{S:.1e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def change(ratio: float) -> str:
    """A ratio as a change in percent."""
    return f"{100.0 * (ratio - 1.0):+.0f} %"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
