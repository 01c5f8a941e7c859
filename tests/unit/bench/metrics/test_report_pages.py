import pytest

from services.bench.metrics.report_pages import OTHERS, report_section
from services.bench.metrics.report_patient import SAID, WALKS
from services.bench.metrics.report_pdf import printed
from services.ingest.source import open_source
from services.report.assemble import make_report
from services.report.charts.colours import TEXT_COLOURS
from services.report.content import Language
from services.report.press import Press
from tests.unit.report import made


@pytest.fixture(scope="module")
def paper():
    report = make_report(made.source(progress=made.progress()), Language.FRENCH)
    return report, printed(Press().pdf(report))


def test_what_is_read_from_a_pdf_is_what_was_printed(paper):
    report, found = paper
    assert (found.pages, found.tagged, found.ua, found.language) == (2, True, True, "fr")
    assert found.title.endswith(report.id)
    assert found.kinds["Figure"] == sum(len(section.charts) for section in report.sections)
    assert found.figures_without_words == 0


def test_colours_of_text_are_found_on_the_page_and_in_its_charts(paper):
    _, found = paper
    assert {TEXT_COLOURS["left"], TEXT_COLOURS["right"], TEXT_COLOURS["ink"]} <= found.text_colours
    assert found.text_colours <= set(TEXT_COLOURS.values())


def test_every_source_of_the_scoreboard_can_be_opened():
    for spec in (*WALKS, *OTHERS.values()):
        assert open_source(spec).describe().session
    assert SAID["aid"] == "cane"
    assert report_section.__doc__
