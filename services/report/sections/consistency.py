"""All strides one by one, on request: a page of thin lines."""

import math

from schemas.gait import Stride
from schemas.vocabulary import Side
from services.report.catalogue import Catalogue
from services.report.charts.curve_chart import CurveLabels
from services.report.charts.strides_chart import strides_chart
from services.report.content import Chart, Section, SectionId
from services.report.source import ReportSource

JOINTS = ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")
MOST_STRIDES = 60
"""Strides drawn of each side at most, the newest."""
DEGREES = 180 / math.pi


def consistency(source: ReportSource, words: Catalogue) -> Section | None:
    """None where the strides were not asked for, or none of them counts."""
    charts = [chart for joint in JOINTS for side in Side if (chart := _chart(source, words, joint, side)) is not None]
    if not charts:
        return None
    return Section(
        id=SectionId.CONSISTENCY, page=3, title=words.text("title.consistency"), sentences=[], charts=charts,
        table=None, notes=[words.text("note.consistency", most=MOST_STRIDES)],
    )  # fmt: skip


def counts(stride: Stride) -> bool:
    """Whether a stride is one that means rest on, but for the first and last of a walk."""
    return stride.valid and not stride.turning


def _chart(source: ReportSource, words: Catalogue, joint: str, side: Side) -> Chart | None:
    name = f"{joint}_{side}"
    told = [each.curves[name] for each in source.strides if each.side is side and counts(each) and name in each.curves]
    if not told:
        return None
    strides = [[value * DEGREES for value in curve.position] for curve in told[-MOST_STRIDES:]]
    title = words.text(
        "format.brackets", text=words.text(f"joint.{joint}"), inside=words.text(f"column.{side}").lower()
    )
    alt = words.text(
        "chart.strides_alt", name=title, count=len(strides), low=f"{words.number(min(map(min, strides)), 0)}°",
        high=f"{words.number(max(map(max, strides)), 0)}°",
    )  # fmt: skip
    labels = CurveLabels(
        title=title,
        description=alt,
        x_axis=words.text("chart.stride_axis"),
        y_axis=words.text("chart.angle_axis"),
        letters={each: words.text(f"side.{each}_letter") for each in Side},
        decimal_mark=words.text("format.decimal_mark"),
    )
    identity = f"strides-{name.replace('_', '-')}"
    return Chart(id=identity, title=title, svg=strides_chart(identity, side, strides, labels), alt=alt, columns=6)
