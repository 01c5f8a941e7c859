"""The scoreboard of the Rhythmic EKF as a folder: report.md, its charts, every row."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from services.bench.joukov.curve import curve_ratio
from services.bench.joukov.simulation import JERK_EDGES, SweepStudy, add_bins
from services.bench.joukov.study import FIRST, GRID, QUANTITIES, UNITS, Study
from services.bench.line_chart import line_chart
from services.bench.scoreboard import Row, Scoreboard

S_LABEL = "process noise S, (rad/s3)^2"


def write_report(
    folder: Path,
    scoreboard: Scoreboard,
    sweeps: Mapping[str, Sequence[SweepStudy]],
    studies: Mapping[str, Sequence[Study]],
) -> None:
    """Write report.md and SVG files into `folder`, which is made if need be."""
    folder.mkdir(parents=True, exist_ok=True)
    charts = _charts(sweeps, studies)
    for name, svg in charts.items():
        (folder / f"{name}.svg").write_text(svg)
    lines = [f"# {scoreboard.title}", "", scoreboard.note, "", *_table([r for r in scoreboard.rows if not r.detail])]
    for name in charts:
        lines += ["", f"![{name.replace('_', ' ')}]({name}.svg)"]
    lines += ["", "## Every row", "", *_table([r for r in scoreboard.rows if r.detail])]
    (folder / "report.md").write_text("\n".join(lines) + "\n")


def _charts(sweeps: Mapping[str, Sequence[SweepStudy]], studies: Mapping[str, Sequence[Study]]) -> dict[str, str]:
    charts = {}
    for name, sweep in sweeps.items():
        slug = name.replace(" ", "_")
        charts[f"{slug}_jerk"] = jerk_chart(f"{name}: acceleration error over jerk at S*/10", sweep)
        for i, quantity in enumerate(QUANTITIES):
            title = f"{name}: {quantity} error over S"
            charts[f"{slug}_{quantity}"] = error_chart(title, [item.study for item in sweep], i)
    for kind, study in studies.items():
        slug = kind.replace(", ", "_").replace(" ", "_")
        charts[f"curve_{slug}"] = ratio_chart(f"{kind}: rhythmic over plain EKF", study)
    return charts


def jerk_chart(title: str, sweep: Sequence[SweepStudy]) -> str:
    """Figure 6: how far the acceleration is behind, by the jerk."""
    lines = {}
    for name in sweep[0].bins:
        bins = add_bins([item.bins[name][1] for item in sweep])
        lines[name] = [
            (float(edge), float(np.degrees(bins.lag[i] / bins.count[i])))
            for i, edge in enumerate(JERK_EDGES[:-1])
            if bins.count[i] > 0.0
        ]
    return line_chart(title, "|jerk| from, rad/s3", "acceleration behind by, deg/s2", lines)


def error_chart(title: str, studies: Sequence[Study], quantity: int) -> str:
    """Median RMSE over S of each filter."""
    lines = {}
    for name in studies[0].curves:
        error = np.degrees(np.median([study.curves[name][FIRST:, quantity] for study in studies], axis=0))
        lines[name] = list(zip(GRID[FIRST:].tolist(), error.tolist(), strict=True))
    return line_chart(title, S_LABEL, f"median RMSE, {UNITS[quantity]}", lines, log_x=True)


def ratio_chart(title: str, studies: Sequence[Study]) -> str:
    """Median ratio to the plain filter over S: the trusted rhythm in all quantities, the published in acceleration."""
    trusted, published = curve_ratio(studies, "trusted"), curve_ratio(studies, "published")
    lines = {name: _points(trusted[:, i]) for i, name in enumerate(QUANTITIES)}
    lines["acceleration, published"] = _points(published[:, 2])
    return line_chart(title, S_LABEL, "median ratio of RMSE", lines, log_x=True)


def _points(values: NDArray[np.float64]) -> list[tuple[float, float]]:
    return list(zip(GRID[FIRST:].tolist(), values.tolist(), strict=True))


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
