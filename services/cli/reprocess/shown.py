"""What was recomputed, as a person reads it and as JSON."""

import math
from typing import Any

from rich.console import Console
from rich.table import Table

from schemas.metrics import Metric
from services.cli.reprocess.recompute import Recomputed
from services.cli.reprocess.sessions import Outcome
from services.flow.software import SOFTWARE
from services.versions.difference import MEANING, ChangeKind, Difference, MetricChange, difference

IN_TABLE = (ChangeKind.CHANGED, ChangeKind.WITHHELD, ChangeKind.GIVEN)


def verdict(outcome: Outcome) -> str:
    """One line on a session, after its name."""
    result = outcome.result
    if result is None:
        return f"{'skipped' if outcome.under_way else 'not recomputed'}: {outcome.problem}"
    if result.stored is None:
        return "nothing was stored to compare with"
    changed = _difference(result)
    if result.same_software and result.same_messages:
        return f"identical, computed by {SOFTWARE}"
    if result.broken:
        return f"NOT identical, though {SOFTWARE} computed both"
    if changed.identical:
        return f"identical, computed by {result.stored.software} and by {SOFTWARE}"
    kinds = [change.kind for change in changed.metrics]
    counted = [f"{kinds.count(kind)} {kind}" for kind in ChangeKind if kind in kinds]
    curves = [f"{len(changed.curves)} curves"] if changed.curves else []
    said = ", ".join([*counted, *curves]) or "other phases, repetitions or quality"
    if result.same_software:
        return f"{said}: how late sensors and camera were to each other decided when it was recorded"
    return f"{said}: {result.stored.software} -> {SOFTWARE}"


def show(outcome: Outcome, console: Console) -> None:
    """The verdict, what has to be known about it, and a row for each metric that changed."""
    result = outcome.result
    title = "" if result is None else f" ({result.description.title})"
    console.print(f"[bold]{outcome.session}[/bold]{title}: {verdict(outcome)}", highlight=False)
    if result is None:
        return
    for note in result.notes:
        console.print(f"  note: {note}", highlight=False)
    if outcome.file is not None:
        console.print(f"  stored: {outcome.session}/{outcome.file}", highlight=False)
    if result.broken:
        for stream in result.differing:
            console.print(f"  {stream.stream} differs from message {stream.first} on", highlight=False)
        console.print("  An altered file, another processor or other libraries can do that; see `ambula doctor`.")
    if result.stored is not None:
        _show_changes(_difference(result).metrics, console)


def _show_changes(changes: list[MetricChange], console: Console) -> None:
    """A table of those that have or had a value, and the names of the others by what became of them."""
    rows = [change for change in changes if change.kind in IN_TABLE]
    if rows:
        console.print(_table(rows))
    for kind in (kind for kind in ChangeKind if kind not in IN_TABLE):
        named = _names([change.metric for change in changes if change.kind is kind])
        if named:
            console.print(f"  {kind} ({MEANING[kind]}): {'; '.join(named)}", highlight=False)


def _names(metrics: list[Metric]) -> list[str]:
    """Each once, with the sides that it is about."""
    sides: dict[str, list[str]] = {}
    for metric in metrics:
        sides.setdefault(metric.name.replace("_", " "), []).extend([metric.side] if metric.side else [])
    return [f"{name} ({', '.join(about)})" if about else name for name, about in sides.items()]


def _difference(result: Recomputed) -> Difference:
    if result.stored is None or result.metrics is None:
        return Difference(False, [], [])
    return difference(result.stored, result.metrics)


def _table(changes: list[MetricChange]) -> Table:
    kinds = [kind for kind in ChangeKind if any(change.kind is kind for change in changes)]
    table = Table(caption="\n".join(f"{kind}: {MEANING[kind]}" for kind in kinds), caption_justify="left")
    for heading in ("metric", "side", "unit", "was", "is", "change", "of its interval", ""):
        table.add_column(heading, justify="left" if heading in ("metric", "side", "unit", "") else "right")
    for change in changes:
        metric = change.metric
        unit, scale = ("deg", 180 / math.pi) if metric.unit == "rad" else (metric.unit, 1.0)
        relative = change.change_in_intervals
        table.add_row(
            metric.name.replace("_", " "),
            metric.side or "",
            unit,
            _value(change.before, scale),
            _value(change.after, scale),
            "" if change.change is None else f"{change.change * scale:+.3g}",
            "" if relative is None else f"{relative:+.2g}",
            change.kind,
        )
    return table


def _value(metric: Metric | None, scale: float) -> str:
    if metric is None:
        return "-"
    return f"withheld: {metric.withheld_because}" if metric.value is None else f"{metric.value * scale:.4g}"


def as_json(outcome: Outcome) -> dict[str, Any]:
    """Everything about a session, numbers in SI units."""
    result = outcome.result
    row: dict[str, Any] = {"session": outcome.session, "says": verdict(outcome), "problem": outcome.problem}
    if result is None:
        return row
    changed = _difference(result)
    return row | {
        "title": result.description.title,
        "stored_software": None if result.stored is None else result.stored.software,
        "stored_version": result.stored_version,
        "software": SOFTWARE,
        "file": outcome.file,
        "notes": result.notes,
        "identical_messages": result.same_messages,
        "identical_metrics": result.stored is not None and changed.identical,
        "streams_that_differ": [
            {"stream": each.stream, "stored": each.stored, "recomputed": each.recomputed, "first": each.first}
            for each in result.differing
        ],
        "metrics": [_change_as_json(change) for change in changed.metrics],
        "curves": [{"degree_of_freedom": each.degree_of_freedom, "largest": each.largest} for each in changed.curves],
    }


def _change_as_json(change: MetricChange) -> dict[str, Any]:
    return {
        "name": change.metric.name,
        "side": change.metric.side,
        "unit": change.metric.unit,
        "kind": change.kind,
        "before": None if change.before is None else change.before.model_dump(mode="json"),
        "after": None if change.after is None else change.after.model_dump(mode="json"),
        "change": change.change,
        "change_in_intervals": change.change_in_intervals,
    }
