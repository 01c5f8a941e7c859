"""Whether a number may take part in a verdict."""

from schemas.metrics import DoubtKind, Metric, TrustGrade

ENOUGH = (TrustGrade.GOOD, TrustGrade.FAIR)


def is_trusted(metric: Metric) -> bool:
    """Graded fair or good, or poor for nothing but a wide interval: that of the change is judged itself."""
    wide = bool(metric.doubts) and all(doubt.kind is DoubtKind.WIDE_INTERVAL for doubt in metric.doubts)
    return metric.grade in ENOUGH or (metric.grade is TrustGrade.POOR and wide)
