"""Session metrics as a table in the terminal."""

import math

from rich.table import Table

from schemas.metrics import Metric, SessionMetrics


def metrics_table(metrics: SessionMetrics, title: str) -> Table:
    """One row a metric; angles in degrees."""
    table = Table(title=title)
    for heading in ("metric", "side", "value", "spread", "unit", "strides"):
        table.add_column(heading, justify="right" if heading in ("value", "spread", "strides") else "left")
    for metric in metrics.metrics:
        unit, scale = ("deg", 180 / math.pi) if metric.unit == "rad" else (metric.unit, 1.0)
        table.add_row(
            metric.name.replace("_", " "),
            metric.side or "",
            metric.withheld_because or _number(metric, scale),
            "" if metric.spread is None else f"{metric.spread * scale:.3g}",
            unit,
            str(metric.strides),
        )
    return table


def _number(metric: Metric, scale: float) -> str:
    return "-" if metric.value is None else f"{metric.value * scale:.4g}"
