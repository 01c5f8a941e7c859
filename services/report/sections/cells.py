"""Fields of tables: a metric with its spread and trust, a reference, a change, a threshold."""

from collections.abc import Callable

from schemas.metrics import Metric
from schemas.vocabulary import Side
from services.progress.rules import Verdict
from services.report.catalogue import NOT_KNOWN, Catalogue
from services.report.content import Cell, Tone
from services.report.phrases import grade_word
from services.report.source import MeasureProgress, ReferenceRange, VisitValue
from services.report.units import Measured

EMPTY = Cell(text=NOT_KNOWN, note=None, tone=Tone.QUIET, span=1)


def plain(text: str, note: str | None = None, span: int = 1) -> Cell:
    """Ordinary text."""
    return Cell(text=text, note=note, tone=Tone.PLAIN, span=span)


def metric_cell(words: Catalogue, metric: Metric | None, span: int = 1) -> Cell:
    """`1.12 ± 0.04` with its trust as a word; a withheld one says so."""
    if metric is None:
        return EMPTY.model_copy(update={"span": span})
    if metric.value is None:
        return Cell(text=NOT_KNOWN, note=words.text("grade.withheld").lower(), tone=Tone.WITHHELD, span=span)
    measured = Measured.of(words, metric)
    text = measured.bare(metric.value)
    if metric.spread is not None:
        text = words.text("format.plus_minus", value=text, spread=measured.bare(metric.spread))
    return Cell(text=text, note=grade_word(words, metric.grade).lower(), tone=Tone.PLAIN, span=span)


def place(value: float, reference: ReferenceRange) -> str:
    """below, within or above."""
    if value < reference.low:
        return "below"
    return "above" if value > reference.high else "within"


def by_side(words: Catalogue, texts: dict[Side | None, str]) -> str:
    """Texts of the sides behind their letters, the same text once; of the whole body as it is."""
    if None in texts:
        return texts[None]
    if len(texts) > 1 and len(set(texts.values())) == 1:
        return next(iter(texts.values()))
    return " · ".join(f"{words.text(f'side.{side}_letter')} {text}" for side, text in texts.items())


def reference_cell(words: Catalogue, measured: Measured, reference: ReferenceRange | None) -> Cell:
    """`1.05 to 1.50`; whose it is stands in the notes."""
    if reference is None:
        return EMPTY
    span = words.text("format.span", low=measured.bare(reference.low), high=measured.bare(reference.high))
    return plain(span)


def sides_cell(words: Catalogue, texts: dict[Side | None, str], notes: Callable[[], str] | None = None) -> Cell:
    """One field for both sides; a dash where there is nothing."""
    if not texts:
        return EMPTY
    return plain(by_side(words, texts), None if notes is None else notes() or None)


def change_text(measured: Measured, value: VisitValue) -> str:
    """`+0.12`."""
    return measured.bare(value.change, signed=True)


def verdict_word(words: Catalogue, verdict: Verdict | None) -> str:
    """real change, within measurement error, cannot tell."""
    return words.text(f"verdict.{verdict or Verdict.CANNOT_TELL}")


def mdc_text(measured: Measured, history: MeasureProgress | None) -> str | None:
    """The threshold that was frozen with the baseline."""
    return None if history is None or history.mdc is None else measured.bare(history.mdc)
