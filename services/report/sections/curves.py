"""Mean curves over the stride: pelvic tilt, hip, knee, ankle."""

import math

from schemas.metrics import MeanCurve
from schemas.vocabulary import Side
from services.report.catalogue import Catalogue
from services.report.charts.curve_chart import CurveBand, CurveLabels, SideCurve, curve_chart
from services.report.content import Chart, Section, SectionId
from services.report.sections.reference_note import kind_text, short_origin
from services.report.source import ReportSource

JOINTS = ("pelvis_tilt", "hip_flexion", "knee_flexion", "ankle_dorsiflexion")
"""The sagittal plane, from the pelvis down."""

DEGREES = 180 / math.pi

DATUMS = (
    ("mean posture of healthy adults", "population"),
    ("taken for the rest posture", "rest_posture"),
    ("as the camera shows them", "camera"),
    ("the straightest the knee had been", "straightest"),
    ("the sensors' own x axes", "sensor_axes"),
    ("the standing that was marked", "marked"),
    ("quiet standing", "standing"),
)
"""By what estimators say of their zero, the first that fits."""


def curves(source: ReportSource, words: Catalogue) -> Section | None:
    """None where the session has none of these curves."""
    seen = [joint for joint in JOINTS if _of_joint(source, joint)]
    if not seen:
        return None
    charts = [_chart(source, words, joint, 12 // max(3, len(seen))) for joint in seen]
    notes = [
        words.text("note.cycle"),
        words.text("note.positive", datum=datum(source, words)),
        _reference(source, words),
    ]
    return Section(
        id=SectionId.CURVES, page=1, title=words.text("title.curves"), sentences=[], charts=charts, table=None,
        notes=notes,
    )  # fmt: skip


def datum(source: ReportSource, words: Catalogue) -> str:
    """What an angle of zero means, in the language where the catalogue knows the datum."""
    if source.calibration is None:
        return words.text("reference.datum_unknown")
    said = source.calibration.datum
    return next((words.text(f"datum.{key}") for mark, key in DATUMS if mark in said), said)


def _of_joint(source: ReportSource, joint: str) -> dict[Side | None, MeanCurve]:
    names: dict[str, Side | None] = {joint: None, **{f"{joint}_{side}": side for side in Side}}
    return {names[each.degree_of_freedom]: each for each in source.metrics.curves if each.degree_of_freedom in names}


def _chart(source: ReportSource, words: Catalogue, joint: str, width: int) -> Chart:
    name = words.text(f"joint.{joint}")
    sides = [_side(source, side, curve) for side, curve in sorted(_of_joint(source, joint).items(), key=_left_first)]
    reference = next((each for each in source.reference_curves if each.joint == joint), None)
    band = None
    if reference is not None:
        band = CurveBand([v * DEGREES for v in reference.low], [v * DEGREES for v in reference.high])
    alt = words.text("chart.curve_alt", name=name, sides=" ".join(_words_of(words, side) for side in sides))
    labels = CurveLabels(
        title=name,
        description=alt,
        x_axis=words.text("chart.stride_axis"),
        y_axis=words.text("chart.angle_axis"),
        letters={side: words.text(f"side.{side}_letter") for side in Side},
        decimal_mark=words.text("format.decimal_mark"),
    )
    identity = f"curve-{joint.replace('_', '-')}"
    svg = curve_chart(identity, sides, band, labels)
    columns = 4 if width >= 4 else 3
    return Chart(id=identity, title=name, svg=svg, alt=alt, columns=columns)


def _left_first(item: tuple[Side | None, MeanCurve]) -> str:
    return item[0] or ""


def _side(source: ReportSource, side: Side | None, curve: MeanCurve) -> SideCurve:
    stance = source.value("stance_fraction", side) if side is not None else None
    mean, spread = [v * DEGREES for v in curve.mean], [v * DEGREES for v in curve.spread]
    return SideCurve(side, mean, spread, None if stance is None else 100 * stance)


def _words_of(words: Catalogue, curve: SideCurve) -> str:
    side = words.text("chart.whole" if curve.side is None else f"column.{curve.side}")
    start, low, high = (f"{words.number(value, 0)}°" for value in (curve.mean[0], min(curve.mean), max(curve.mean)))
    if curve.toe_off is None:
        return words.text("chart.curve_alt_side_plain", side=side, start=start, low=low, high=high)
    toe_off = words.number(curve.toe_off, 0)
    return words.text("chart.curve_alt_side", side=side, start=start, low=low, high=high, toe_off=toe_off)


def _reference(source: ReportSource, words: Catalogue) -> str:
    shown = [each for each in source.reference_curves if each.joint in JOINTS]
    if not shown:
        return words.text("reference.no_curves", datum=datum(source, words))
    first = shown[0]
    return words.text("reference.curves", kind=kind_text(words, first), who=short_origin(words, first.origin))
