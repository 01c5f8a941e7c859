from xml.etree import ElementTree

from schemas.gait import CURVE_POINTS, Stride, StrideCurve
from schemas.vocabulary import Side
from services.report.assemble import make_report
from services.report.content import Language, SectionId

SVG = "{http://www.w3.org/2000/svg}"


def stride(index, side=Side.LEFT, because=None, **changes) -> Stride:
    curve = StrideCurve(position=[0.3 + 0.01 * index] * CURVE_POINTS, position_std=0.02)
    fields = {
        "side": side, "index": index, "start_ns": index * 10**9, "toe_off_ns": None, "opposite_contact_ns": None,
        "opposite_toe_off_ns": None, "end_ns": (index + 1) * 10**9, "stride_time_s": 1.0, "stance_fraction": None,
        "step_time_s": None, "step_length_m": None, "step_length_std_m": None, "stride_length_m": None,
        "walking_speed": None, "step_width_m": None, "circumduction_m": None, "turn": None, "phase_advance": None,
        "turning": False, "valid": because is None, "rejected_because": because,
        "curves": {f"knee_flexion_{side}": curve},
    }  # fmt: skip
    return Stride(**(fields | changes))


def consistency(report):
    return next((each for each in report.sections if each.id == SectionId.CONSISTENCY), None)


def test_every_stride_that_counts_is_one_thin_line(made):
    strides = (
        *(stride(n) for n in range(5)),
        stride(5, because="samples are missing within the stride"),
        stride(6, turning=True),
    )
    section = consistency(make_report(made.source(strides=strides), Language.ENGLISH))
    assert section.page == 3
    (chart,) = section.charts
    assert len(list(ElementTree.fromstring(chart.svg).iter(f"{SVG}path"))) == 5
    assert "5 strides" in chart.alt


def test_no_more_than_the_newest_sixty_are_drawn(made):
    strides = tuple(stride(n) for n in range(80))
    (chart,) = consistency(make_report(made.source(strides=strides), Language.ENGLISH)).charts
    assert len(list(ElementTree.fromstring(chart.svg).iter(f"{SVG}path"))) == 60


def test_without_strides_there_is_no_such_page(made):
    assert consistency(make_report(made.source(), Language.ENGLISH)) is None


def test_why_strides_were_rejected_is_told_with_how_often(made):
    why = "the other foot did not come down within the stride"
    strides = (stride(0), stride(1, because=why), stride(2, because=why), stride(3, because="something new"))
    report = make_report(made.source(strides=strides), Language.FRENCH)
    limits = next(each for each in report.sections if each.id == SectionId.LIMITS)
    said = " ".join(limits.sentences)
    assert "l’autre pied ne s’est pas posé (2)" in said
    assert "une anomalie de mesure (1)" in said
