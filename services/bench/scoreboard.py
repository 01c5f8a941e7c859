"""A table of measured figures beside what they should be."""

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from rich.console import Console
from rich.table import Table


@dataclass(frozen=True)
class Row:
    """One figure. `value` None: it could not be measured, `target` then may say why."""

    name: str
    value: float | None
    unit: str
    target: str | None
    met: bool | None
    baseline: float | None


def at_most(name: str, value: float, unit: str, limit: float, baseline: float | None = None) -> Row:
    """A figure that must not be larger than `limit`."""
    return Row(name, value, unit, f"<= {limit:g}", value <= limit, baseline)


def at_least(name: str, value: float, unit: str, limit: float, baseline: float | None = None) -> Row:
    """A figure that must not be smaller than `limit`."""
    return Row(name, value, unit, f">= {limit:g}", value >= limit, baseline)


def informative(name: str, value: float | None, unit: str, baseline: float | None = None) -> Row:
    """A figure without a target."""
    return Row(name, value, unit, None, None, baseline)


@dataclass(frozen=True)
class Scoreboard:
    """The figures of one benchmark."""

    title: str
    rows: list[Row]
    note: str = ""

    @property
    def missed(self) -> list[Row]:
        """Rows that did not reach their target."""
        return [row for row in self.rows if row.met is False]

    def print(self) -> None:
        """Write the table to the terminal."""
        table = Table(title=self.title, caption=self.note or None, caption_justify="left")
        for heading in ("figure", "value", "unit", "target", "", "baseline"):
            table.add_column(heading, justify="right" if heading in ("value", "baseline") else "left")
        for row in self.rows:
            table.add_row(
                row.name, _number(row.value), row.unit, row.target or "", _mark(row.met), _number(row.baseline)
            )
        Console().print(table)

    def write_json(self, path: Path) -> None:
        """Write the rows as {name, value, unit, target, met, baseline}."""
        document = {"title": self.title, "note": self.note, "rows": [asdict(row) for row in self.rows]}
        path.write_text(json.dumps(document, indent=2) + "\n")


def _number(value: float | None) -> str:
    if value is None:
        return ""
    if value == 0.0 or 0.001 <= abs(value) < 1e5:
        return f"{value:.4g}" if abs(value) < 1000 else f"{value:.0f}"
    return f"{value:.2e}"


def _mark(met: bool | None) -> str:
    return "" if met is None else "[green]met[/green]" if met else "[red]missed[/red]"
