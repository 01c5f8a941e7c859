"""Header with the quality line, and the footer of every page."""

from schemas.metrics import TrustGrade
from schemas.session import SessionDescription
from schemas.vocabulary import Side, Task
from services.definitions.variability import COUNTED, ENDS, REJECTED, TURNING
from services.report.catalogue import Catalogue
from services.report.content import Fact, Footer, Header, QualityLine
from services.report.phrases import grade_word, subject_name
from services.report.sections.scope import EXERCISES, WALKING_TESTS, in_scope
from services.report.source import ReportSource

LONGEST_SILENCE_S = 1.0
"""s: a sensor that was silent longer is named in the quality line."""
LARGEST_LOSS = 0.05
"""Share: a sensor that lost more is named in the quality line."""
HASH_LETTERS = 16


def header(source: ReportSource, words: Catalogue) -> Header:
    """Title, the facts of the test and how far the data may be relied on."""
    task = source.description.task
    kind = "gait"
    if task in EXERCISES:
        kind = "exercise"
    elif task is Task.TIMED_UP_AND_GO:
        kind = "timed_up_and_go"
    elif task in WALKING_TESTS:
        kind = "test"
    return Header(
        title=words.text(f"title.{kind}"),
        subtitle=f"{_capital(words.text(f'task.{task}'))}, {words.day(source.began.date())}",
        facts=_facts(source, words),
        quality=quality_line(source, words),
    )


def test_name(description: SessionDescription, words: Catalogue) -> str:
    """The test with its variant: `ten-metre walk (timed from 2 to 8 m, walking start)`."""
    said, variant = description.conditions, []
    if said.timed_from_m is not None and said.timed_to_m is not None:
        ends = {"from_m": _metres(words, said.timed_from_m), "to_m": _metres(words, said.timed_to_m)}
        variant.append(words.text("variant.zone", **ends))
    if said.test_duration_s is not None:
        variant.append(words.text("variant.duration", minutes=_metres(words, said.test_duration_s / 60)))
    if description.walkway_m is not None:
        variant.append(words.text("variant.walkway", length=_metres(words, description.walkway_m)))
    if said.start is not None:
        variant.append(words.text(f"variant.{said.start}"))
    if said.physical_assistance:
        variant.append(words.text("variant.assisted"))
    name = words.text(f"task.{description.task}")
    return words.text("format.brackets", text=name, inside=", ".join(variant)) if variant else name


def _metres(words: Catalogue, value: float) -> str:
    return words.number(value, 0 if value == round(value) else 1)


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _facts(source: ReportSource, words: Catalogue) -> list[Fact]:
    said, patient, progress = source.description.conditions, source.patient, source.progress
    unsaid = words.text("header.not_said")
    code = words.text("header.unassigned") if patient is None else patient.code
    born = unsaid if patient is None or patient.year_of_birth is None else str(patient.year_of_birth)
    visit = words.text("header.unassigned")
    if progress is not None:
        visit = str(progress.visit)
    aid, orthosis, footwear, speed = (
        unsaid if value is None else words.text(f"{kind}.{value}")
        for kind, value in (
            ("aid", said.aid), ("orthosis", said.orthosis), ("footwear", said.footwear),
            ("speed", said.speed_instruction),
        )
    )  # fmt: skip
    rows = [
        ("code", code), ("born", born), ("visit", visit), ("test", test_name(source.description, words)),
        ("aid", aid), ("orthosis", orthosis), ("footwear", footwear),
    ]  # fmt: skip
    if source.description.task not in EXERCISES:
        rows.append(("speed", speed))
    rows.append(("paretic", unsaid if said.paretic_side is None else words.text(f"side.{said.paretic_side}")))
    rows.append(("sensors", _sensors(source.description, words)))
    return [Fact(label=words.text(f"header.{key}"), text=text) for key, text in rows]


def _sensors(description: SessionDescription, words: Catalogue) -> str:
    segments = [sensor.segment for hub in description.hubs for sensor in hub.sensors]
    parts = []
    if segments:
        names = [words.text(f"segment.{segment}") for segment in segments]
        parts.append(words.text("sensors.inertial", segments=", ".join(names)))
    if description.cameras:
        parts.append(words.text("sensors.camera"))
    return words.text("format.semicolon").join(parts) or words.text("header.not_said")


def quality_line(source: ReportSource, words: Catalogue) -> QualityLine:
    """Loss, cycles used of all, and what a therapist should know before reading on."""
    quality, parts, warnings = source.metrics.quality, [], _calibration_warnings(source, words)
    if quality is not None and quality.sources:
        expected = sum(each.expected for each in quality.sources)
        used = sum(each.used for each in quality.sources)
        loss = 0.0 if expected == 0 else max(0.0, 1 - used / expected)
        parts.append(words.text("quality.loss", loss=words.number(100 * loss, 1)))
        if quality.spanned_s > 0:
            share = words.number(100 * min(1.0, quality.estimated_s / quality.spanned_s), 0)
            parts.append(words.text("quality.estimated", share=share))
        warnings += _source_warnings(source, words)
    else:
        parts.append(words.text("quality.unknown"))
    parts.append(_cycles(source, words))
    grade = worst_grade(source)
    text = words.text("format.semicolon").join(part for part in parts if part)
    head, word = words.text("quality.head"), grade_word(words, grade)
    title = words.text("format.colon", label=head, text=word)
    return QualityLine(grade=grade, head=head, word=word, title=title, text=text, warnings=warnings)


def worst_grade(source: ReportSource) -> TrustGrade | None:
    """The middle one of the grades that the given values have: half of them are at least as good."""
    order = (TrustGrade.GOOD, TrustGrade.FAIR, TrustGrade.POOR)
    grades = sorted(
        order.index(each.grade) for each in in_scope(source) if each.grade in order and each.value is not None
    )
    return order[grades[len(grades) // 2]] if grades else None


def _calibration_warnings(source: ReportSource, words: Catalogue) -> list[str]:
    calibration, quality = source.calibration, source.metrics.quality
    warnings = []
    if quality is not None and not quality.calibrated:
        warnings.append(words.text("quality.not_calibrated"))
    elif (quality is not None and not quality.absolute) or (calibration is not None and not calibration.absolute):
        warnings.append(words.text("quality.not_absolute"))
    return warnings


def _source_warnings(source: ReportSource, words: Catalogue) -> list[str]:
    quality = source.metrics.quality
    assert quality is not None
    segments = {sensor.name: sensor.segment for hub in source.description.hubs for sensor in hub.sensors}
    warnings = []
    for each in quality.sources:
        name = _capital(subject_name(words, segments.get(each.name, each.name)))
        if each.misplaced:
            warnings.append(words.text("quality.misplaced", sensor=name))
        if each.longest_silence_s > LONGEST_SILENCE_S:
            seconds = words.number(each.longest_silence_s, 1)
            warnings.append(words.text("quality.silent", sensor=name, seconds=seconds))
        elif each.expected and 1 - each.used / each.expected > LARGEST_LOSS:
            loss = words.number(100 * (1 - each.used / each.expected), 0)
            warnings.append(words.text("quality.sensor_loss", sensor=name, loss=loss))
    if quality.late:
        warnings.append(words.one_or_more("quality.late", quality.late))
    return warnings


def count_of(source: ReportSource, name: str) -> int:
    """A count over both sides; 0 where the session has none."""
    return round(sum(each.value or 0 for each in source.metrics.metrics if each.name == name))


def _cycles(source: ReportSource, words: Catalogue) -> str:
    kinds = {
        "repetitions": ("repetitions_counted", ("repetitions_rejected",)),
        "attempts": ("tug_attempts", ("tug_attempts_aborted",)),
        "strides": (COUNTED, (TURNING, REJECTED, ENDS)),
    }
    for kind, (counted, others) in kinds.items():
        used = count_of(source, counted)
        total = used + sum(count_of(source, name) for name in others)
        if total:
            return words.text(f"quality.{kind}", used=used, total=total)
    return ""


def footer(source: ReportSource, words: Catalogue, report_id: str) -> Footer:
    """Code, visit, report, software, references and the recording's hash."""
    items = []
    if source.patient is not None:
        items.append(words.text("footer.code", code=source.patient.code))
    if source.progress is not None:
        items.append(words.text("footer.visit", number=source.progress.visit))
    items.append(words.text("footer.report", id=report_id))
    items.append(words.text("footer.software", software=source.metrics.software))
    items.append(words.text("footer.estimator", name=source.description.estimator))
    items.append(", ".join(source.installed_sets) or words.text("reference.no_set"))
    if source.recording_sha256 is None:
        items.append(words.text("footer.no_recording"))
    else:
        items.append(words.text("footer.recording", hash=source.recording_sha256[:HASH_LETTERS]))
    return Footer(items=items, disclaimer=words.text("footer.disclaimer"), page=words.text("footer.page"))


def sides_seen(source: ReportSource) -> set[Side]:
    """Sides of which at least one number has a value."""
    return {Side(each.side) for each in source.metrics.metrics if each.side is not None and each.value}
