import hashlib
import io
import json

import pytest
from pypdf import PdfReader

from schemas.archive_layout import Manifest, RecordingState, SegmentEntry
from schemas.signals import STRIDE
from schemas.vocabulary import Side
from services.flow.message import Stream, encode_payload
from services.gateway.access.scope import EVERYTHING
from services.gateway.report.gather import recording_digest
from services.gateway.sessions import records
from services.gateway.sessions.models import SessionState

WALK = "8d0c2a71f04be655"


@pytest.fixture
def walked(client, gateway, made):
    """A finished walk of a patient; gives the session's id."""
    code = client.post("/v1/patients", json={"year_of_birth": 1957, "sex": "female"}).json()["code"]
    gateway.keeper.appeared(made.describe(WALK))
    gateway.keeper.measured(WALK, made.metrics_at(60.0, final=True))
    client.patch(f"/v1/sessions/{WALK}", json={"patient": code})
    return WALK


def keep(folder, state: RecordingState, **sums: str) -> None:
    folder.mkdir(parents=True)
    files = [
        SegmentEntry(name=f"{name}.mcap", size_bytes=10, sha256=value, messages=1, streams=[], damage=None)
        for name, value in sums.items()
    ]
    manifest = Manifest(
        session=folder.name, title="Walk", protocol="walk", origin="synthetic", estimator="ekf", started_unix_ns=0,
        duration_s=1.0, state=state, state_reason=None, derived_version="0.1.0", files=files,
    )  # fmt: skip
    (folder / "manifest.json").write_text(manifest.model_dump_json())


def test_the_report_comes_as_content_page_and_pdf_with_one_id(client, walked):
    content = client.get(f"/v1/sessions/{walked}/report").json()
    page = client.get(f"/v1/sessions/{walked}/report.html")
    pdf = client.get(f"/v1/sessions/{walked}/report.pdf")
    assert page.headers["content-type"].startswith("text/html")
    assert content["id"] in page.text
    assert pdf.headers["content-type"] == "application/pdf"
    assert content["id"] in PdfReader(io.BytesIO(pdf.content)).pages[0].extract_text()


def test_the_pdf_is_the_same_when_it_is_asked_for_again(client, walked):
    first, again = (client.get(f"/v1/sessions/{walked}/report.pdf").content for _ in range(2))
    assert first == again


def test_the_report_speaks_the_language_that_was_asked_for(client, walked):
    french = client.get(f"/v1/sessions/{walked}/report", params={"language": "fr"}).json()
    assert french["header"]["title"] == "Compte rendu d’analyse de la marche"
    assert client.get(f"/v1/sessions/{walked}/report", params={"language": "xx"}).status_code == 422


def test_the_report_knows_patient_visit_references_and_that_there_is_no_recording(client, walked):
    footer = " ".join(client.get(f"/v1/sessions/{walked}/report").json()["footer"]["items"])
    assert "visit 1" in footer
    assert "mobbs_2025" in footer
    assert "recording not archived" in footer


def test_the_footer_bears_the_hash_of_the_recording(client, walked, settings):
    keep(settings.data_dir / walked, RecordingState.FINISHED, raw="ab" * 32)
    footer = " ".join(client.get(f"/v1/sessions/{walked}/report").json()["footer"]["items"])
    assert "recording sha256 abababababababab" in footer


def test_the_digest_of_several_files_is_that_of_their_sums(tmp_path):
    keep(tmp_path / "s", RecordingState.FINISHED, raw="11" * 32, raw_001="22" * 32)
    lines = f"{'11' * 32}  raw.mcap\n{'22' * 32}  raw_001.mcap\n"
    assert recording_digest(tmp_path, "s") == hashlib.sha256(lines.encode()).hexdigest()


def test_a_recording_that_still_grows_has_no_digest(tmp_path):
    keep(tmp_path / "s", RecordingState.RECORDING, raw="11" * 32)
    assert recording_digest(tmp_path, "s") is None
    assert recording_digest(tmp_path, "t") is None


@pytest.mark.parametrize("form", ["report", "report.html", "report.pdf"])
def test_without_final_metrics_there_is_no_report_and_the_answer_says_what_to_do(client, gateway, made, form):
    assert client.get(f"/v1/sessions/nobody/{form}").status_code == 404
    gateway.keeper.appeared(made.describe(WALK))
    gateway.keeper.measured(WALK, made.metrics_at(20.0, final=False))
    answer = client.get(f"/v1/sessions/{WALK}/{form}")
    assert answer.status_code == 409
    assert answer.headers["content-type"] == "application/problem+json"
    assert "Stop it" in answer.json()["next_step"]


def test_a_session_that_broke_off_can_be_computed_from_its_recording(client, gateway, made):
    gateway.keeper.appeared(made.describe(WALK))
    gateway.keeper.measured(WALK, made.metrics_at(20.0, final=False))
    with gateway.database.transaction(EVERYTHING) as database:
        records.record_end(database, WALK, SessionState.INTERRUPTED, "the feed broke off")
    answer = client.get(f"/v1/sessions/{WALK}/report")
    assert answer.status_code == 409
    assert f"ambula reprocess {WALK}" in answer.json()["next_step"]


def test_the_page_is_one_that_the_policy_of_the_gateway_lets_be(client, walked):
    answer = client.get(f"/v1/sessions/{walked}/report.html")
    assert "default-src 'none'" in answer.headers["content-security-policy"]
    assert "<script" not in answer.text
    assert "http" not in answer.text.replace("http://www.w3.org/2000/svg", "")


def test_words_of_a_language_can_be_read(client):
    english, french = (client.get(f"/v1/wording/{language}").json() for language in ("en", "fr"))
    assert english.keys() == french.keys()
    assert french["metric.walking_speed"] == "Vitesse de marche"
    assert client.get("/v1/wording/xx").status_code == 404


def test_the_report_is_json_without_anything_that_is_no_number(client, walked):
    json.loads(client.get(f"/v1/sessions/{walked}/report").text, parse_constant=pytest.fail)


@pytest.fixture
def recorded_walk(client, gateway, settings, made, recorded, tape):
    """Session `a` with six strides in its recording, one of them rejected."""
    gateway.keeper.appeared(made.describe("a"))
    with gateway.database.transaction(EVERYTHING) as database:
        records.record_metrics(database, "a", made.metrics_at(9.0, final=True))
    folder = settings.data_dir / "a"
    folder.mkdir(parents=True)
    stream = Stream(STRIDE, "segmentation")
    messages = []
    for number in range(6):
        stride = made.stride_at(2.0 + number, (Side.LEFT, Side.RIGHT)[number % 2], number)
        if number == 5:
            stride = stride.model_copy(update={"valid": False, "rejected_because": "shorter than a stride can be"})
        at = stride.end_ns
        messages.append(tape.record(stream, number, payload=encode_payload(stride), captured_ns=at))
    recorded(messages, folder=folder)
    return "a"


def test_on_request_every_stride_is_drawn_and_rejections_have_their_reason(client, recorded_walk):
    asked = client.get(f"/v1/sessions/{recorded_walk}/report", params={"strides": True}).json()
    assert asked["sections"][-1]["id"] == "consistency"
    knee = next(chart for chart in asked["sections"][-1]["charts"] if chart["id"] == "strides-knee-flexion-left")
    assert knee["svg"].count("<path") == 3
    without = client.get(f"/v1/sessions/{recorded_walk}/report").json()
    assert "consistency" not in [section["id"] for section in without["sections"]]
    pdf = client.get(f"/v1/sessions/{recorded_walk}/report.pdf", params={"strides": True})
    assert len(PdfReader(io.BytesIO(pdf.content)).pages) == 3


def test_strides_of_a_session_without_recording_are_not_found(client, walked):
    answer = client.get(f"/v1/sessions/{walked}/report", params={"strides": True})
    assert answer.status_code == 404
    assert "without its strides" in answer.json()["next_step"]
