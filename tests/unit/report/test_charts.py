from xml.etree import ElementTree

import pytest

from schemas.vocabulary import Side
from services.report.charts import colours
from services.report.charts.axes import digits_of, ticks
from services.report.charts.canvas import FONT
from services.report.charts.curve_chart import CurveBand, CurveLabels, SideCurve, curve_chart
from services.report.charts.labels import Label, apart
from services.report.charts.progress_chart import (
    ProgressLabels,
    ProgressLine,
    TreatmentMark,
    VisitMark,
    progress_chart,
)

SVG = "{http://www.w3.org/2000/svg}"
LETTERS = {Side.LEFT: "L", Side.RIGHT: "R"}
WORDS = ProgressLabels("Speed", "Speed by visit.", "m/s", "visit", LETTERS, ".")


def marks(*values, real=0):
    return [
        VisitMark(k + 1, value, value - 0.02, value + 0.02, k == 0, real if k else 0) for k, value in enumerate(values)
    ]


def drawn(real: int) -> ElementTree.Element:
    line = ProgressLine(None, marks(0.5, 0.8, real=real), 0.5, 0.15)
    return ElementTree.fromstring(progress_chart("p", [line], (1.0, 1.4), [TreatmentMark(1.5, "A")], WORDS))


def test_a_triangle_stands_only_for_a_real_change():
    def triangles(svg):
        return [e for e in svg.iter(f"{SVG}path") if e.get("d", "").endswith("Z")]

    assert len(triangles(drawn(1))) == 1
    assert triangles(drawn(0)) == []


def test_a_chart_has_title_and_description_that_it_refers_to():
    svg = drawn(1)
    labels = svg.get("aria-labelledby").split()
    assert [svg.find(f"{SVG}{tag}").get("id") for tag in ("title", "desc")] == labels
    assert svg.find(f"{SVG}desc").text == "Speed by visit."


def curves(band=None, toe_off=60.0) -> ElementTree.Element:
    wave = [float(k % 50) for k in range(101)]
    sides = [SideCurve(side, wave, [2.0] * 101, toe_off) for side in Side]
    labels = CurveLabels("Knee", "Knee & stride <100 %>", "stride, %", "degrees", LETTERS, ",")
    return ElementTree.fromstring(curve_chart("c", sides, band, labels))


def test_sides_differ_by_colour_dash_and_letter():
    svg = curves()
    lines = [e for e in svg.iter(f"{SVG}path") if e.get("fill") == "none"]
    assert [(e.get("stroke"), e.get("stroke-dasharray")) for e in lines] == [("#C44E00", None), ("#0072B2", "5 2.5")]
    letters = [e.text for e in svg.iter(f"{SVG}text") if e.text in ("L", "R")]
    assert sorted(letters) == ["L", "L", "R", "R"]


def test_toe_off_is_dotted_and_only_where_it_is_known():
    dotted = [e for e in curves().iter(f"{SVG}line") if e.get("stroke-dasharray") == "1 2"]
    assert len(dotted) == 2
    assert [e for e in curves(toe_off=None).iter(f"{SVG}line") if e.get("stroke-dasharray")] == []


def test_a_reference_is_grey_and_only_where_it_is_given():
    def grey(svg):
        return [e for e in svg.iter(f"{SVG}path") if e.get("fill") == colours.REFERENCE]

    assert grey(curves()) == []
    assert len(grey(curves(CurveBand([0.0] * 101, [40.0] * 101)))) == 1


@pytest.mark.parametrize("svg", [curves(), drawn(1)])
def test_nothing_needs_a_style_sheet_a_script_or_another_file(svg):
    assert {element.tag.removeprefix(SVG) for element in svg.iter()} <= {
        "svg", "title", "desc", "line", "path", "rect", "circle", "text"
    }  # fmt: skip
    names = {name for element in svg.iter() for name in element.attrib}
    assert not names & {"style", "class", "href", "onload"}


@pytest.mark.parametrize("svg", [curves(), drawn(1)])
def test_text_is_written_in_colours_that_are_checked(svg):
    used = {element.get("fill") for element in svg.iter(f"{SVG}text")}
    assert used <= set(colours.TEXT_COLOURS.values())


@pytest.mark.parametrize(
    ("ground", "text"), [(ground, text) for ground, all in colours.TEXT_ON.items() for text in all]
)
def test_text_stands_out_from_its_ground(text, ground):
    assert colours.contrast(colours.TEXT_COLOURS[text], ground) >= 4.5


def test_contrast_is_that_of_the_conventions():
    assert colours.contrast("#C44E00", "#FFFFFF") == pytest.approx(4.73, abs=0.01)
    assert colours.contrast("#0072B2", "#FFFFFF") == pytest.approx(5.19, abs=0.01)
    assert colours.contrast("#D55E00", "#FFFFFF") == pytest.approx(3.87, abs=0.01)


def test_ticks_are_round_and_hold_the_values():
    for low, high in ((0.0, 1.0), (-13.2, 47.9), (0.31, 0.33), (250.0, 410.0)):
        found = ticks(low, high)
        assert found[0] <= low
        assert found[-1] >= high
        assert 2 <= len(found) <= 8
    assert digits_of(0.25) == 2
    assert digits_of(10.0) == 0


def test_labels_are_moved_apart_and_keep_their_order():
    placed = apart([Label(10.0, "R", "b"), Label(9.0, "L", "a")], 8.0)
    assert [label.text for label in placed] == ["L", "R"]
    assert placed[1].at - placed[0].at == pytest.approx(8.0)


def test_names_of_faces_are_such_that_a_browser_takes_them_without_quotes():
    # A name with a part that begins with a digit would make the whole list invalid.
    assert all(part[0].isalpha() for name in FONT.split(",") for part in name.split())
