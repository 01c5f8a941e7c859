import io
import subprocess
import sys
import threading
from html.parser import HTMLParser

import pytest
from pypdf import PdfReader

from schemas.vocabulary import Task
from services.report.assemble import make_report
from services.report.content import Language
from services.report.html import page

ALONE = """
import hashlib, sys
from services.report.content import Report
from services.report.press import Press
print(hashlib.sha256(Press().pdf(Report.model_validate_json(sys.stdin.read()))).hexdigest())
"""


@pytest.fixture
def report(made):
    return make_report(made.source(progress=made.progress()), Language.FRENCH)


def structure(reader: PdfReader) -> list[str]:
    """Kinds of all structure elements, in reading order."""

    def walk(node) -> list[str]:
        node = node.get_object() if hasattr(node, "get_object") else node
        if not hasattr(node, "get"):
            return []
        kids = node.get("/K", [])
        kids = kids if isinstance(kids, list) else [kids]
        return [str(node.get("/S"))] + [kind for kid in kids for kind in walk(kid)]

    return walk(reader.trailer["/Root"]["/StructTreeRoot"])


def test_the_pdf_is_tagged_and_has_title_language_and_words_for_its_charts(press, report):
    reader = PdfReader(io.BytesIO(press.pdf(report)))
    root = reader.trailer["/Root"]
    assert root["/MarkInfo"]["/Marked"]
    assert root["/Lang"] == "fr"
    assert reader.metadata.title == f"{report.header.title} {report.id}"
    kinds = structure(reader)
    assert kinds.count("/Figure") == sum(len(each.charts) for each in report.sections)
    assert kinds.count("/Table") == sum(each.table is not None for each in report.sections)
    assert {"/H1", "/H2", "/TH"} <= set(kinds)


def test_the_pdf_has_two_pages_with_the_footer_on_each(press, report):
    pages = [text.extract_text() for text in PdfReader(io.BytesIO(press.pdf(report))).pages]
    assert len(pages) == 2
    for number, text in enumerate(pages, start=1):
        assert f"Page {number} sur 2" in text
        assert "Ne pas utiliser pour le diagnostic" in text
        assert report.id in text


def test_metadata_hold_nothing_of_the_patient(press, report):
    metadata = PdfReader(io.BytesIO(press.pdf(report))).metadata
    assert "K7QM3F" not in str(dict(metadata))
    assert metadata.author is None
    assert metadata.creation_date.date().isoformat() == report.made_for


def test_the_same_report_has_the_same_bytes_again_in_threads_and_in_another_process(press, report):
    first, found = press.pdf(report), []
    threads = [threading.Thread(target=lambda: found.append(press.pdf(report))) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [first] * 3
    told = subprocess.run(
        [sys.executable, "-c", ALONE], input=report.model_dump_json(), capture_output=True, text=True, check=True
    )
    import hashlib

    assert told.stdout.strip() == hashlib.sha256(first).hexdigest()


@pytest.mark.parametrize("task", [Task.TIMED_UP_AND_GO, Task.KNEE_FLEXION, Task.SIX_MINUTE_WALK])
def test_every_kind_of_report_can_be_printed(press, made, task):
    metrics = made.session_metrics(phases=made.tug_phases(), repetitions=made.knee_repetitions())
    given = made.source(description=made.described(task=task), metrics=metrics)
    for language in Language:
        assert press.pdf(make_report(given, language)).startswith(b"%PDF")


def test_pictures_are_one_png_per_page(press, report):
    pictures = press.pictures(report, 40)
    assert len(pictures) == 2
    assert all(picture.startswith(b"\x89PNG") for picture in pictures)


class Seen(HTMLParser):
    def __init__(self):
        super().__init__()
        self.tags, self.attributes = [], set()

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes |= {name for name, _ in attrs}


def test_the_page_stands_alone_under_a_strict_policy(report):
    seen = Seen()
    seen.feed(page(report))
    assert not {"script", "link", "img", "iframe", "object", "form"} & set(seen.tags)
    assert not {"style", "src", "onclick", "onload"} & seen.attributes
    assert seen.tags.count("table") == sum(each.table is not None for each in report.sections)


def test_what_is_typed_in_cannot_become_markup(made):
    bad = '<script>alert("1")</script> #eval("1") $x$ *_'
    given = made.source(installed_sets=(bad,))
    report = make_report(given, Language.ENGLISH)
    assert "<script>" not in page(report)


def test_typst_takes_what_is_typed_in_as_text(press, made):
    report = make_report(made.source(installed_sets=('#eval("1") $x$ *_ \\',)), Language.ENGLISH)
    text = PdfReader(io.BytesIO(press.pdf(report))).pages[0].extract_text()
    assert '#eval("1") $x$ *_ \\' in text.replace("\n", " ")
