"""Symmetry by one printed formula, and leg against leg: recovery or compensation."""

from services.definitions.definition import PARETIC_RATIO_SUFFIX, RATIO_SUFFIX
from services.report.catalogue import Catalogue
from services.report.content import Column, Row, Section, SectionId, Table
from services.report.phrases import joint_name, rule_sentence
from services.report.sections import cells
from services.report.sections.measure_table import measure_table
from services.report.source import ReportSource
from services.report.units import Measured


def symmetry(source: ReportSource, words: Catalogue) -> Section | None:
    """One formula: paretic / non-paretic where a side is declared, else larger / smaller. None without any ratio."""
    names = [metric.name for metric in source.metrics.metrics]
    suffix = PARETIC_RATIO_SUFFIX if any(name.endswith(PARETIC_RATIO_SUFFIX) for name in names) else RATIO_SUFFIX
    shown = [name for name in names if name.endswith(suffix)]
    title = words.text("title.symmetry")
    table = measure_table(source, words, shown, title)
    if table is None:
        return None
    formula = words.text("note.ratio_paretic" if suffix == PARETIC_RATIO_SUFFIX else "note.ratio_larger")
    return Section(id=SectionId.SYMMETRY, page=2, title=title, sentences=[], charts=[], table=table, notes=[formula])


def sides(source: ReportSource, words: Catalogue) -> Section | None:
    """Curves of one leg against the other's, joint by joint, beside speed, hip rotation and circumduction."""
    if not source.metrics.sides:
        return None
    measured = Measured(words, "rad", "side_distance")
    rows = [
        Row(
            head=joint_name(words, each.joint),
            note=measured.symbol,
            cells=[
                cells.plain(measured.bare(each.rmse)),
                cells.plain(measured.bare(each.rmse_about_mean)),
                cells.plain(measured.bare(each.rmse_std)),
                cells.plain(str(each.strides)),
            ],
        )
        for each in source.metrics.sides
    ]
    title = words.text("title.sides")
    heads = ("joint", "rmse", "about_mean", "scatter", "strides")
    columns = [Column(head=words.text(f"column.{head}"), side=None, numeric=head != "joint") for head in heads]
    side = words.text(f"side.of_{source.metrics.sides[0].reference_side}")
    notes = [words.text("note.sides", side=side), *_beside(source, words)]
    return Section(
        id=SectionId.SIDES, page=2, title=title, sentences=_words_of_joints(source, words), charts=[],
        table=Table(caption=title, columns=columns, rows=rows), notes=notes,
    )  # fmt: skip


def _words_of_joints(source: ReportSource, words: Catalogue) -> list[str]:
    joints = () if source.progress is None else source.progress.joints
    measured = Measured(words, "rad", "side_distance")
    sentences = []
    for each in joints:
        reason = rule_sentence(words, each.rules[0], measured) if each.rules else ""
        verdict = words.text(f"joint_word.{each.word}")
        label = words.text("format.colon", label=joint_name(words, each.joint), text=verdict)
        sentences.append(f"{label}. {reason}".strip())
    return sentences


def _beside(source: ReportSource, words: Catalogue) -> list[str]:
    texts = {}
    for key, name in (
        ("speed", "walking_speed"),
        ("rotation", "hip_rotation_range"),
        ("circumduction", "circumduction"),
    ):
        found = {each.side: each for each in source.metrics.metrics if each.name == name and each.value is not None}
        if not found:
            return []
        shown = {side: Measured.of(words, metric).full(metric.value) for side, metric in found.items()}
        parts = [
            text if side is None else f"{words.text(f'side.{side}_letter')} {text}" for side, text in shown.items()
        ]
        texts[key] = ", ".join(parts)
    return [words.text("note.compensation", **texts)]
