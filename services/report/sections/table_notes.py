"""The small print of a table of measures: what +- means, whose the reference is, where a threshold comes from."""

from collections.abc import Sequence

from schemas.metrics import TrustGrade
from services.report.catalogue import Catalogue
from services.report.phrases import first_rule, grade_word
from services.report.sections.reference_note import reference_notes
from services.report.source import ReportSource
from services.report.units import Measured


def table_notes(source: ReportSource, words: Catalogue, names: Sequence[str]) -> list[str]:
    """Notes on the rows `names`."""
    grades = ", ".join(
        grade_word(words, grade).lower() for grade in (TrustGrade.GOOD, TrustGrade.FAIR, TrustGrade.POOR)
    )
    notes = [words.text("note.interval", grades=grades)]
    references = [each for each in source.references if each.metric in names]
    notes += reference_notes(words, references) if references else [_no_reference(source, words, names)]
    notes.append(_changes(source, words, names))
    return notes


def _no_reference(source: ReportSource, words: Catalogue, names: Sequence[str]) -> str:
    gaps = [gap.because for gap in source.reference_gaps if gap.metric in names]
    return words.text(
        f"reference.gap_{gaps[0]}" if gaps and words.has(f"reference.gap_{gaps[0]}") else "reference.none"
    )


def _changes(source: ReportSource, words: Catalogue, names: Sequence[str]) -> str:
    progress = source.progress
    if progress is None or progress.baseline_visit is None or progress.baseline_day is None:
        return words.text("note.no_baseline")
    if progress.baseline_visit == progress.visit:
        return words.text("note.is_baseline")
    rules = []
    for history in progress.measures:
        if history.metric not in names:
            continue
        name, measured = words.metric(history.metric), Measured(words, history.unit, history.metric)
        if history.mdc is not None and history.mdc_people is not None:
            known = words.messages.get(f"people.{history.mdc_people}", history.mdc_people)
            whose = words.text("format.brackets", text=known, inside=history.mdc_source)
            text = words.text("format.colon", label=name, text=f"{measured.full(history.mdc)}, {whose}")
            if text not in rules:
                rules.append(text)
    if rules:
        return words.text("note.mdc", rules=words.text("format.semicolon").join(rules) + ".")
    why = next((h for h in progress.measures if h.metric in names and h.why_no_mdc), None)
    if why is None:
        return words.text("note.no_mdc", reason="").strip()
    return words.text("note.no_mdc", reason=first_rule(words, why.why_no_mdc, Measured(words, why.unit, why.metric)))
