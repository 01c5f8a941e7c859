"""The check finds what is wrong: each mutilation of a right bundle is named."""

import copy
from dataclasses import replace

import pytest

from services.exports.fhir.bundle import bundle
from services.exports.fhir.ucum import is_ucum
from services.exports.fhir.validation import problems


@pytest.fixture(scope="module")
def right(source):
    """A few numbers of each kind are enough."""
    some = [each for each in source.metrics.metrics if each.name in ("walking_speed", "step_length", "step_width")]
    return bundle(replace(source, metrics=source.metrics.model_copy(update={"metrics": some})))


@pytest.fixture
def made(right):
    assert problems(right) == []
    return copy.deepcopy(right)


@pytest.fixture
def first(made):
    """The first resource of a type, or the first Observation with a value."""

    def find(kind):
        found = [entry["resource"] for entry in made["entry"] if entry["resource"]["resourceType"] == kind]
        return next(each for each in found if kind != "Observation" or "valueQuantity" in each)

    return find


def put(key, value):
    return lambda resource: resource.__setitem__(key, value)


def coding(**changes):
    return lambda resource: resource["code"]["coding"][0].update(changes)


MISTAKES = [
    ("Patient", put("name", [{"text": "Erika Mustermann"}]), "name has no place here"),
    ("Patient", put("birthDate", "1957-03-02"), "more than a year"),
    ("Patient", lambda it: it["identifier"][0].update(value="Erika M"), "no patient code"),
    ("Patient", put("gender", "unknown"), "gender"),
    ("Patient", lambda it: it.pop("meta"), "meta is missing"),
    ("Observation", put("status", "amended"), "status 'amended'"),
    ("Observation", lambda it: it.pop("status"), "status is missing"),
    ("Observation", put("text", {"status": "generated", "div": "<div>Erika</div>"}), "text has no place"),
    ("Observation", lambda it: it["category"][0]["coding"][0].update(code="exam"), "exam is no code"),
    ("Observation", coding(code="step_hight"), "step_hight is no code"),
    ("Observation", coding(system="http://loinc.org", code="LA29042-4"), "answer in a survey"),
    ("Observation", coding(system="http://loinc.org", code="41957-2"), "is no code of http://loinc.org"),
    ("Observation", coding(system="http://snomed.info/sct", code="129006008"), "is no code of http://snomed.info"),
    (
        "Observation",
        lambda it: it["component"][0]["code"]["coding"][0].update(it["category"][0]["coding"][0]),
        "no code of http://terminology.hl7.org/CodeSystem/observation-category belongs there",
    ),
    ("Observation", lambda it: it["valueQuantity"].update(code="meter/second"), "no UCUM unit"),
    ("Observation", lambda it: it["valueQuantity"].update(code="km/h"), "no UCUM unit of ours"),
    ("Observation", lambda it: it["valueQuantity"].update(system="http://units"), "no UCUM unit"),
    ("Observation", lambda it: it["valueQuantity"].update(value=float("nan")), "is no number"),
    ("Observation", lambda it: it["valueQuantity"].update(value="0.5"), "is no number"),
    ("Observation", lambda it: it.pop("valueQuantity"), "either one value or dataAbsentReason"),
    ("Observation", put("dataAbsentReason", {"text": "because"}), "either one value or dataAbsentReason"),
    ("Observation", lambda it: it["component"][0].pop("valueInteger"), "component cycles_counted"),
    ("Observation", lambda it: it["component"].append(it["component"][0]), "two components say the same"),
    ("Observation", lambda it: it["subject"].update(reference="Patient/1"), "not in the bundle"),
    ("Observation", lambda it: it.update(subject=it["device"]), "subject points to a Device"),
    ("Observation", put("issued", "2026-09-07T09:30:00"), "no instant"),
    ("Observation", lambda it: it["effectivePeriod"].update(end="2026-09-07T09:29:00Z"), "before it ends"),
    ("DiagnosticReport", lambda it: it["result"].pop() and it.pop("result"), "result is missing"),
    ("DiagnosticReport", lambda it: it["presentedForm"][0].update(data="JVBERi0x"), "size is"),
    ("DiagnosticReport", lambda it: it["presentedForm"][0].update(data="not base64!"), "no base64"),
    ("DiagnosticReport", lambda it: it["presentedForm"][0].update(data="PGh0bWw+"), "no PDF"),
    ("DiagnosticReport", lambda it: it["presentedForm"][0].update(hash="AAAA"), "hash"),
    ("DiagnosticReport", lambda it: it["presentedForm"][0].update(contentType="text/html"), "contentType"),
    ("DocumentReference", lambda it: it["content"][0]["attachment"].update(url="/v1/sessions"), "opened elsewhere"),
    ("DocumentReference", lambda it: it["content"][0]["attachment"].update(data="AAAA"), "exactly one of"),
    ("DocumentReference", put("status", "superseded"), "status 'superseded'"),
    ("Device", put("id", "device-1"), "is not that of its resource"),
    ("Device", put("resourceType", "Group"), "has no place in our bundles"),
]


@pytest.mark.parametrize(("kind", "mistake", "found"), MISTAKES, ids=[found for _, _, found in MISTAKES])
def test_a_mistake_is_found(made, first, kind, mistake, found):
    mistake(first(kind))
    assert any(found in each for each in problems(made)), problems(made)


@pytest.mark.parametrize(
    ("mistake", "found"),
    [
        (put("type", "batch"), "no Bundle of type collection"),
        (put("timestamp", "today"), "no instant"),
        (lambda made: made["entry"].append(made["entry"][0]), "the same fullUrl"),
        (lambda made: made["entry"].pop(), "exactly one DiagnosticReport"),
    ],
)
def test_a_mistake_of_the_bundle_is_found(made, mistake, found):
    mistake(made)
    assert any(found in each for each in problems(made))


def test_what_somebody_typed_is_found_wherever_it_stands(made, first, secrets):
    first("Device")["deviceName"][0]["name"] = f"sensors of {secrets[0]}"
    assert any("somebody typed" in each for each in problems(made, secrets))


UCUM = (
    "m", "s", "m/s", "m/s2", "m.s-2", "m/s/min", "1", "%", "deg", "deg/s", "deg/{repetition}", "{steps}/min", "/min",
    "cm", "kg", "10*3",
)  # fmt: skip
NOT_UCUM = (
    "", "m s", "metre", "m//s", "m/", "degrees", "°", "sec", "m/s²", "{steps", "steps}", "M", "k", "kmin",
)  # fmt: skip


@pytest.mark.parametrize("unit", UCUM)
def test_units_of_ucum(unit):
    assert is_ucum(unit)


@pytest.mark.parametrize("unit", NOT_UCUM)
def test_what_is_no_unit_of_ucum(unit):
    assert not is_ucum(unit)
