"""A report from what is known of a session: which sections it has, in which order, and its id."""

import hashlib
from collections.abc import Callable

from schemas.vocabulary import Task
from services.report.catalogue import Catalogue, catalogue
from services.report.content import Language, Report, Section, SectionId
from services.report.sections.consistency import consistency
from services.report.sections.curve_distance import curve_distance
from services.report.sections.curves import curves
from services.report.sections.header import footer, header
from services.report.sections.key_points import key_points
from services.report.sections.limits import limits
from services.report.sections.progress import progress
from services.report.sections.repetitions import repetitions
from services.report.sections.scope import EXERCISES, WALKING_TESTS
from services.report.sections.summary import summary
from services.report.sections.symmetry import sides, symmetry
from services.report.sections.test_result import test_result
from services.report.sections.time_distance import time_distance
from services.report.source import ReportSource

Maker = Callable[[ReportSource, Catalogue], Section | None]

WALK: tuple[Maker, ...] = (
    summary, time_distance, curves, key_points, symmetry, sides, progress, curve_distance, limits,
    consistency,
)  # fmt: skip
"""Clinical conventions, section 10.3."""
WALKING_TEST: tuple[Maker, ...] = (
    summary, test_result, time_distance, curves, key_points, symmetry, progress, limits, consistency,
)  # fmt: skip
"""The test's own result comes before the walking in it; leg against leg is a matter of a walk without turns."""
STANDING: tuple[Maker, ...] = (summary, repetitions, test_result, symmetry, progress, limits)
"""Of exercises and of marching in place, where there is no walking to tell of."""
CHAIR: tuple[Maker, ...] = (summary, test_result, progress, limits)
"""Of the timed up and go, whose few strides are no gait analysis."""

ID_LETTERS = 8


def make_report(source: ReportSource, language: Language) -> Report:
    """The whole report. The same values and words give the same report with the same id."""
    words = catalogue(language)
    task = source.description.task
    found = [section for make in _makers(task) if (section := make(source, words)) is not None]
    unsigned = Report(
        id="",
        language=language,
        session=source.description.session,
        made_for=source.began.date().isoformat(),
        header=header(source, words),
        sections=[_placed(section, task) for section in found],
        footer=footer(source, words, ""),
    )
    digest = hashlib.sha256(unsigned.model_dump_json().encode()).hexdigest().upper()
    identity = f"R-{digest[: ID_LETTERS // 2]}-{digest[ID_LETTERS // 2 : ID_LETTERS]}"
    return unsigned.model_copy(update={"id": identity, "footer": footer(source, words, identity)})


def _makers(task: Task) -> tuple[Maker, ...]:
    if task in EXERCISES or task is Task.MARCHING:
        return STANDING
    if task in WALKING_TESTS:
        return WALKING_TEST
    return CHAIR if task is Task.TIMED_UP_AND_GO else WALK


def _placed(section: Section, task: Task) -> Section:
    """Where a test's result takes the first page, the curves stand on the second."""
    moved = task in WALKING_TESTS and section.id is SectionId.CURVES
    return section.model_copy(update={"page": 2}) if moved else section
