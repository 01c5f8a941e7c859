"""What a bundle says, checked by our own check and by the package fhir.resources."""

import base64
import json

import pytest
from fhir.resources.R4B.bundle import Bundle

from schemas.conditions import UNSAID
from schemas.population import Sex
from services.definitions.table import DEFINITIONS
from services.exports.fhir.bundle import bundle
from services.exports.fhir.codes import ABSENT, DETAILS, METRICS, SNOMED
from services.exports.fhir.source import Subject
from services.exports.fhir.validation import problems


def code_of(element):
    return element["code"]["coding"][0]["code"]


def component(observation, name):
    found = [each for each in observation["component"] if code_of(each) == name]
    assert len(found) == 1, name
    return found[0]


@pytest.fixture(scope="module")
def made(source):
    return bundle(source)


@pytest.fixture
def observed(made, of_kind):
    """Observations by code and side."""
    return {
        (code_of(each), each.get("bodySite", {}).get("coding", [{}])[0].get("display")): each
        for each in of_kind(made, "Observation")
    }


def test_both_checks_find_it_valid(made, secrets):
    assert problems(made, secrets) == []
    Bundle.model_validate(made)
    Bundle.model_validate_json(json.dumps(made))


def test_the_library_keeps_every_element(made):
    """Whatever it did not know it would have dropped or refused."""
    kept = Bundle.model_validate(made).model_dump_json(exclude_none=True)
    assert json.loads(kept) == json.loads(json.dumps(made).replace(".000Z", "Z"))


@pytest.mark.parametrize("left_out", ["subject", "report", "recording"])
def test_it_is_valid_without_what_is_not_known(changed, left_out, secrets):
    made = bundle(changed(**{left_out: None}))
    assert problems(made, secrets) == []
    Bundle.model_validate(made)


def test_a_session_of_which_nothing_was_said_is_valid(changed, description):
    bare = description.model_copy(update={"conditions": UNSAID, "walkway_m": None, "cameras": []})
    assert problems(bundle(changed(description=bare))) == []


def test_the_same_results_give_the_same_bundle(source, made):
    assert json.dumps(bundle(source)) == json.dumps(made)


def test_every_number_leaves_once_but_those_that_say_another_again(observed):
    leaving = [each for each in DEFINITIONS if not each.export_only]
    expected = {(each.name, side) for each in leaving for side in (("left", "right") if each.per_side else (None,))}
    assert observed.keys() == expected | {("test_conditions", None)}


def test_a_number_with_all_that_belongs_to_it(observed):
    speed = observed["walking_speed", None]
    assert (speed["status"], speed["category"][0]["coding"][0]["code"]) == ("final", "procedure")
    amount = {"value": 0.5, "unit": "m/s", "system": "http://unitsofmeasure.org", "code": "m/s"}
    assert speed["valueQuantity"] == amount
    assert speed["effectivePeriod"] == {"start": "2026-09-07T09:30:00.000Z", "end": "2026-09-07T09:31:00.000Z"}
    assert component(speed, "cycles_counted")["valueInteger"] == 24
    assert component(speed, "quality_grade")["valueCodeableConcept"]["coding"][0]["code"] == "quality_grade.good"
    assert component(speed, "walking_aid")["valueCodeableConcept"]["coding"][0]["code"] == "walking_aid.cane"
    assert component(speed, "method")["valueCodeableConcept"]["coding"][0]["code"] == "method.rhythmic_ekf"
    assert component(speed, "software")["valueString"] == "ambula 0.1.0+1f2e3d4c"
    assert component(speed, "device_set")["valueString"] == (
        "2 inertial sensors: shank left, pelvis; depth camera: kinect v2"
    )
    ends = [component(speed, f"interval_95_{end}")["valueQuantity"]["value"] for end in ("low", "high")]
    assert ends == [0.48, 0.52]
    assert component(speed, "standard_deviation")["valueQuantity"] == amount | {"value": 0.05}
    assert "referenceRange" not in speed


def test_angles_leave_in_degrees_with_their_interval(observed):
    flexion = observed["knee_flexion_range", "left"]
    assert flexion["valueQuantity"] == {
        "value": 28.6478898, "unit": "deg", "system": "http://unitsofmeasure.org", "code": "deg",
    }  # fmt: skip
    assert component(flexion, "interval_95_low")["valueQuantity"]["value"] == pytest.approx(27.5019742)
    units = {each["valueQuantity"]["code"] for each in observed.values() if "valueQuantity" in each}
    assert units >= {"1", "m", "m/s", "s", "deg", "deg/s", "{steps}/min"}
    assert "rad" not in units


def test_own_codes_first_and_foreign_ones_only_where_they_are_exact(observed):
    foreign = {}
    for (name, _), observation in observed.items():
        own, *others = observation["code"]["coding"]
        assert own["system"] == (DETAILS if name == "test_conditions" else METRICS)
        for other in others:
            foreign[name] = (other["system"], other["code"])
    assert foreign == {"walking_speed": (SNOMED, "724237005"), "step_length": (SNOMED, "250000008")}


def test_a_withheld_number_says_why_and_names_no_device(observed):
    width = observed["step_width", None]
    assert "valueQuantity" not in width
    assert width["dataAbsentReason"]["coding"][0] == {
        "system": ABSENT, "code": "unsupported", "display": "Unsupported",
    }  # fmt: skip
    assert width["dataAbsentReason"]["text"] == "the sensor of shank left and the camera did not tell it"
    assert component(width, "quality_grade")["valueCodeableConcept"]["coding"][0]["code"] == "quality_grade.withheld"


def test_conditions_are_said_once_and_what_nobody_said_is_unknown(observed):
    said = observed["test_conditions", None]
    assert component(said, "walkway")["valueQuantity"]["value"] == 10.0
    assert component(said, "paretic_side")["valueCodeableConcept"]["coding"][0]["display"] == "left"
    assert component(said, "physical_assistance")["valueBoolean"] is False
    assert component(said, "footwear")["dataAbsentReason"]["coding"][0]["code"] == "unknown"
    assert component(said, "test_duration")["valueQuantity"]["code"] == "s"


def test_what_is_not_final_is_preliminary(changed, results, of_kind):
    made = bundle(changed(metrics=results.model_copy(update={"final": False}), report=None))
    assert problems(made) == []
    resources = [*of_kind(made, "Observation"), *of_kind(made, "DiagnosticReport")]
    assert {each["status"] for each in resources} == {"preliminary"}


def test_a_patient_is_a_code(made, of_kind):
    (patient,) = of_kind(made, "Patient")
    assert patient["identifier"][0]["value"] == "K7QM3F"
    assert (patient["birthDate"], patient["gender"]) == ("1957", "female")
    assert patient["meta"]["security"][0]["code"] == "PSEUDED"
    assert patient.keys() == {"resourceType", "id", "meta", "identifier", "birthDate", "gender"}


@pytest.mark.parametrize(("born", "told"), [(1937, True), (1936, False), (None, False)])
def test_the_oldest_are_not_told_by_their_year(changed, of_kind, born, told):
    (patient,) = of_kind(bundle(changed(subject=Subject("K7QM3F", born, Sex.MALE))), "Patient")
    assert ("birthDate" in patient) == told


def test_report_and_recording_are_attached_and_linked(made, of_kind, source):
    (report,) = of_kind(made, "DiagnosticReport")
    (form,) = report["presentedForm"]
    assert (form["contentType"], base64.b64decode(form["data"])) == ("application/pdf", source.report.pdf)
    assert len(report["result"]) == len(of_kind(made, "Observation"))
    assert "Not a medical device" in report["conclusion"]
    (recording,) = of_kind(made, "DocumentReference")
    assert recording["content"][0]["attachment"]["url"] == source.recording.url
    assert "ab" * 32 in recording["description"]
    derived = {each["derivedFrom"][0]["reference"] for each in of_kind(made, "Observation")}
    assert derived == {f"urn:uuid:{recording['id']}"}


def test_every_device_is_part_of_the_set(made, of_kind):
    whole, *parts = of_kind(made, "Device")
    assert {part["parent"]["reference"] for part in parts} == {f"urn:uuid:{whole['id']}"}
    kinds = [part["type"]["coding"][0]["code"] for part in parts]
    assert kinds == ["device.inertial_sensor"] * 2 + ["device.depth_camera", "device.software"]
    assert parts[-1]["version"] == [{"value": "0.1.0+1f2e3d4c"}]


def test_numbers_of_another_software_do_not_leave_under_codes_without_meaning(changed, results, withheld, of_kind):
    strange = withheld.model_copy(update={"name": "forgotten_measure"})
    other_unit = withheld.model_copy(update={"name": "walking_speed", "unit": "km/h"})
    made = bundle(changed(metrics=results.model_copy(update={"metrics": [strange, other_unit, withheld]})))
    assert [code_of(each) for each in of_kind(made, "Observation")] == ["test_conditions", "step_width"]
    assert problems(made) == []


def test_an_estimator_of_another_software_is_unknown(changed, description, of_kind):
    made = bundle(changed(description=description.model_copy(update={"estimator": "next_year"})))
    assert problems(made) == []
    assert "dataAbsentReason" in component(of_kind(made, "Observation")[1], "method")
