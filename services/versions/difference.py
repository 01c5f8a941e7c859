"""What changed between two results of the same session: per metric, with the change in units of its interval."""

from dataclasses import dataclass
from enum import StrEnum

from schemas.metrics import MeanCurve, Metric, SessionMetrics

Key = tuple[str, str | None, str]
"""Name, side and unit: a metric in another unit is another metric."""


class ChangeKind(StrEnum):
    """What became of a metric."""

    CHANGED = "changed"
    NEW = "new"
    GONE = "gone"
    WITHHELD = "withheld"
    GIVEN = "given"
    JUDGED = "judged"


MEANING = {
    ChangeKind.CHANGED: "another value",
    ChangeKind.NEW: "was not computed before",
    ChangeKind.GONE: "is not computed any more",
    ChangeKind.WITHHELD: "had a value and is now withheld",
    ChangeKind.GIVEN: "was withheld and now has a value",
    ChangeKind.JUDGED: "the same value, or none, with another spread, interval, number of strides, grade or reason",
}


@dataclass(frozen=True, slots=True)
class MetricChange:
    """One metric that is not the same in both; `before` and `after` are None where it is absent."""

    kind: ChangeKind
    before: Metric | None
    after: Metric | None

    @property
    def metric(self) -> Metric:
        """The one there is, the newer where there are two."""
        metric = self.after or self.before
        assert metric is not None, "a change has at least one side"
        return metric

    @property
    def change(self) -> float | None:
        """Newer minus older value, in the metric's unit; None where one of them has none."""
        if self.before is None or self.after is None or self.before.value is None or self.after.value is None:
            return None
        return self.after.value - self.before.value

    @property
    def change_in_intervals(self) -> float | None:
        """The change as a multiple of half the width of the older value's 95 % interval; the newer's where it had none.

        Beyond 1 the newer value lies outside an interval that is symmetric about the older one.
        """
        half = _half_width(self.before) or _half_width(self.after)
        return None if self.change is None or half is None else self.change / half


@dataclass(frozen=True, slots=True)
class CurveChange:
    """A mean curve that is not the same in both. `largest` is rad, None where one of them is absent."""

    degree_of_freedom: str
    largest: float | None


@dataclass(frozen=True, slots=True)
class Difference:
    """Everything that is not the same. `identical`: to the last bit, except who computed it."""

    identical: bool
    metrics: list[MetricChange]
    curves: list[CurveChange]


def difference(before: SessionMetrics, after: SessionMetrics) -> Difference:
    """What changed from one result to the other, the metrics in the order of the newer."""
    anonymous = after.model_copy(update={"software": before.software})
    older, newer = _by_key(before), _by_key(after)
    kinds = {
        key: _kind(older.get(key), newer.get(key)) for key in (*newer, *(key for key in older if key not in newer))
    }
    changes = [
        MetricChange(kind, older.get(key), newer.get(key)) for key, kind in kinds.items() if kind is not None
    ]  # fmt: skip
    return Difference(before == anonymous, changes, _curves(before.curves, after.curves))


def _by_key(result: SessionMetrics) -> dict[Key, Metric]:
    return {(metric.name, metric.side, metric.unit): metric for metric in result.metrics}


def _kind(before: Metric | None, after: Metric | None) -> ChangeKind | None:
    if before == after:
        return None
    if before is None:
        return ChangeKind.NEW
    if after is None:
        return ChangeKind.GONE
    if before.value == after.value:
        return ChangeKind.JUDGED
    if after.value is None:
        return ChangeKind.WITHHELD
    return ChangeKind.GIVEN if before.value is None else ChangeKind.CHANGED


def _half_width(metric: Metric | None) -> float | None:
    if metric is None or metric.low is None or metric.high is None or metric.high <= metric.low:
        return None
    return (metric.high - metric.low) / 2


def _curves(before: list[MeanCurve], after: list[MeanCurve]) -> list[CurveChange]:
    older = {curve.degree_of_freedom: curve for curve in before}
    newer = {curve.degree_of_freedom: curve for curve in after}
    names = [*newer, *(name for name in older if name not in newer)]
    return [
        CurveChange(name, _largest(older.get(name), newer.get(name)))
        for name in names
        if older.get(name) != newer.get(name)
    ]


def _largest(before: MeanCurve | None, after: MeanCurve | None) -> float | None:
    if before is None or after is None:
        return None
    return max(abs(new - old) for old, new in zip(before.mean, after.mean, strict=True))
