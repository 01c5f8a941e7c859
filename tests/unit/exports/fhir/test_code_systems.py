import pytest
from fhir.resources.R4B.codesystem import CodeSystem

from services.definitions.table import DEFINITIONS
from services.exports.fhir.code_systems import CODE_SYSTEMS
from services.exports.fhir.codes import DETAILS, DISPLAYS, EXACT, METRICS
from services.exports.fhir.ucum import is_ucum
from services.exports.fhir.units import UNITS


@pytest.mark.parametrize(("name", "url"), [("metrics", METRICS), ("details", DETAILS)])
def test_a_code_system_is_valid_and_complete(name, url):
    made = CODE_SYSTEMS[name]()
    CodeSystem.model_validate(made)
    codes = [each["code"] for top in made["concept"] for each in (top, *top.get("concept", []))]
    assert (made["url"], made["content"], made["count"]) == (url, "complete", len(codes))
    assert len(set(codes)) == len(codes)
    assert set(codes) == ({each.name for each in DEFINITIONS} if name == "metrics" else set(DISPLAYS))


def test_every_metric_has_its_sentence_and_unit():
    for concept, definition in zip(CODE_SYSTEMS["metrics"]()["concept"], DEFINITIONS, strict=True):
        assert concept["definition"] == definition.sentence
        said = {each["code"]: each for each in concept["property"]}
        assert said["unit"]["valueString"] == UNITS[definition.unit].code
        assert said["perSide"]["valueBoolean"] is definition.per_side


def test_every_unit_is_ucum_and_every_exact_code_of_a_metric():
    assert [unit for unit in UNITS.values() if not is_ucum(unit.code)] == []
    assert EXACT.keys() <= {each.name for each in DEFINITIONS}
