"""What an exercise amounts to, in sentences."""

from collections.abc import Iterator

from schemas.metrics import Metric
from schemas.vocabulary import Side
from services.report.catalogue import Catalogue
from services.report.source import ReportSource
from services.report.units import Measured

RANGE, SLOPE, TEMPO, COUNTED = (
    "repetition_range", "repetition_range_slope", "repetition_tempo", "repetitions_counted",
)  # fmt: skip


def exercise_sentences(source: ReportSource, words: Catalogue) -> Iterator[str]:
    """How many, how far, how fast, and how the range changed."""
    yield from _counts(source, words)
    for name, key, signed in ((RANGE, "range", False), (TEMPO, "tempo", False), (SLOPE, "range_change", True)):
        for side, metric in _given(source, name).items():
            value = Measured.of(words, metric).full(metric.value, signed=signed)
            who = words.text("chart.whole" if side is None else f"side.{side}")
            yield words.text(f"summary.{key}", value=value, who=who)


def _given(source: ReportSource, name: str) -> dict[Side | None, Metric]:
    found = {side: source.metric(name, side) for side in (None, Side.LEFT, Side.RIGHT)}
    return {side: metric for side, metric in found.items() if metric is not None and metric.value is not None}


def _counts(source: ReportSource, words: Catalogue) -> Iterator[str]:
    counts = {side: round(metric.value or 0) for side, metric in _given(source, COUNTED).items()}
    if None in counts:
        yield words.one_or_more("summary.repetitions_whole", counts[None])
    elif counts:
        left, right = counts.get(Side.LEFT, 0), counts.get(Side.RIGHT, 0)
        yield words.text("summary.repetitions", left=left, right=right)
