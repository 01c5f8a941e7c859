"""A session for hospital information systems, by REST."""

import base64
import io
from http import HTTPStatus

import pytest
from fhir.resources.R4B.bundle import Bundle
from fhir.resources.R4B.codesystem import CodeSystem
from pypdf import PdfReader

from services.exports.fhir.validation import problems

TYPED = "Walk of Erika Mustermann"


def resources(made, kind):
    return [each["resource"] for each in made["entry"] if each["resource"]["resourceType"] == kind]


@pytest.fixture
def patient(client):
    body = {"year_of_birth": 1957, "sex": "female", "population": "stroke_chronic"}
    return client.post("/v1/patients", json=body).json()["code"]


@pytest.fixture
def walked(client, gateway, made, patient):
    """A session of the patient with metrics, final when asked for."""

    def walk(final=True):
        gateway.keeper.appeared(made.describe("a", title=TYPED))
        gateway.keeper.measured("a", made.metrics_at(30.0, final=final))
        client.patch("/v1/sessions/a", json={"patient": patient})

    return walk


def test_a_finished_session_is_a_valid_bundle_with_its_report(client, walked, patient):
    walked()
    answer = client.get("/v1/sessions/a/fhir")
    assert answer.headers["content-type"] == "application/fhir+json"
    made = answer.json()
    assert problems(made, [TYPED]) == []
    Bundle.model_validate(made)
    assert resources(made, "Patient")[0]["identifier"][0]["value"] == patient
    (report,) = resources(made, "DiagnosticReport")
    pdf = PdfReader(io.BytesIO(base64.b64decode(report["presentedForm"][0]["data"])))
    assert patient in pdf.pages[0].extract_text()
    assert not any("Mustermann" in page.extract_text() for page in pdf.pages)
    (recording,) = resources(made, "DocumentReference")
    assert recording["content"][0]["attachment"]["url"] == "http://testserver/v1/sessions/a/recordings"


def test_the_report_can_be_left_out(client, walked):
    walked()
    made = client.get("/v1/sessions/a/fhir?pdf=false").json()
    assert problems(made, [TYPED]) == []
    assert "presentedForm" not in resources(made, "DiagnosticReport")[0]


def test_a_running_session_is_preliminary_and_has_no_report(client, walked):
    walked(final=False)
    made = client.get("/v1/sessions/a/fhir").json()
    assert problems(made, [TYPED]) == []
    assert {each["status"] for each in resources(made, "Observation")} == {"preliminary"}
    assert "presentedForm" not in resources(made, "DiagnosticReport")[0]


def test_what_is_not_there_is_a_problem_with_a_next_step(client, gateway, made):
    assert client.get("/v1/sessions/nobody/fhir").status_code == HTTPStatus.NOT_FOUND
    gateway.keeper.appeared(made.describe("b"))
    answer = client.get("/v1/sessions/b/fhir")
    assert answer.status_code == HTTPStatus.CONFLICT
    assert "no metrics" in answer.text
    assert client.get("/v1/fhir/CodeSystem/loinc").status_code == HTTPStatus.NOT_FOUND


@pytest.mark.parametrize("name", ["metrics", "details"])
def test_code_systems(client, name):
    answer = client.get(f"/v1/fhir/CodeSystem/{name}")
    assert answer.headers["content-type"] == "application/fhir+json"
    CodeSystem.model_validate(answer.json())
