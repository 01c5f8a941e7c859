"""A table of measured figures beside what they should be."""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Protocol

from rich.console import Console
from rich.table import Table


@dataclass(frozen=True)
class Row:
    """One figure. `value` None: it could not be measured, `target` then may say why.

    `detail` rows are always written to files and shown in the terminal on demand.
    """

    name: str
    value: float | None
    unit: str
    target: str | None
    met: bool | None
    baseline: float | None
    detail: bool = False


def at_most(name: str, value: float, unit: str, limit: float, baseline: float | None = None) -> Row:
    """A figure that must not be larger than `limit`."""
    return Row(name, value, unit, f"<= {limit:g}", value <= limit, baseline)


def at_least(name: str, value: float, unit: str, limit: float, baseline: float | None = None) -> Row:
    """A figure that must not be smaller than `limit`."""
    return Row(name, value, unit, f">= {limit:g}", value >= limit, baseline)


def informative(
    name: str, value: float | None, unit: str, baseline: float | None = None, *, detail: bool = False
) -> Row:
    """A figure without a target."""
    return Row(name, value, unit, None, None, baseline, detail)


class Grid(Protocol):
    """A table of text to stand above the figures."""

    @property
    def caption(self) -> str:
        """Its title."""

    @property
    def header(self) -> Sequence[str]:
        """Of the columns."""

    @property
    def rows(self) -> Sequence[Sequence[str]]:
        """The first column is a name."""


@dataclass(frozen=True)
class Scoreboard:
    """The figures of one benchmark."""

    title: str
    rows: list[Row]
    note: str = ""
    grids: Sequence[Grid] = ()

    @property
    def missed(self) -> list[Row]:
        """Rows that did not reach their target."""
        return [row for row in self.rows if row.met is False]

    def print(self, *, details: bool = False) -> None:
        """Write the tables to the terminal."""
        console = Console()
        for grid in self.grids:
            console.print(_drawn(grid))
        table = Table(title=self.title, caption=self.note or None, caption_justify="left")
        for heading in ("figure", "value", "unit", "target", "", "baseline"):
            number = heading in ("value", "baseline")
            table.add_column(heading, justify="right" if number else "left", no_wrap=heading != "figure")
        for row in self.rows:
            if details or not row.detail:
                table.add_row(
                    row.name, _number(row.value), row.unit, row.target or "", _mark(row.met), _number(row.baseline)
                )
        console.print(table)
        hidden = 0 if details else sum(row.detail for row in self.rows)
        if hidden:
            console.print(f"{hidden} more rows with --all or in the --json file")

    def write_json(self, path: Path) -> None:
        """Write the rows as {name, value, unit, target, met, baseline}."""
        rows = [{name: value for name, value in asdict(row).items() if name != "detail"} for row in self.rows]
        document = {"title": self.title, "note": self.note, "rows": rows}
        path.write_text(json.dumps(document, indent=2) + "\n")


def _drawn(grid: Grid) -> Table:
    table = Table(title=grid.caption)
    for i, heading in enumerate(grid.header):
        # Numbers are folded rather than cut on a narrow terminal.
        table.add_column(heading, justify="right" if i else "left", overflow="fold")
    for row in grid.rows:
        table.add_row(*row)
    return table


def _number(value: float | None) -> str:
    if value is None:
        return ""
    if value == 0.0 or 0.001 <= abs(value) < 1e5:
        return f"{value:.4g}" if abs(value) < 1000 else f"{value:.0f}"
    return f"{value:.2e}"


def _mark(met: bool | None) -> str:
    return "" if met is None else "[green]met[/green]" if met else "[red]missed[/red]"
