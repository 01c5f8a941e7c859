import json

import pytest

from services.gateway.openapi_file import FILE, document

METHODS = {"get", "post", "patch"}


@pytest.fixture(scope="module")
def api():
    return document()


def operations(api):
    for path, methods in api["paths"].items():
        for method, operation in methods.items():
            yield f"{method.upper()} {path}", operation


def test_the_published_description_is_that_of_the_code(api):
    # When this fails on purpose: python -m services.gateway.openapi_file
    assert json.loads(FILE.read_text()) == api


def test_every_operation_is_versioned_described_and_tells_its_problems(api):
    for name, operation in operations(api):
        # Prometheus looks for its numbers at a place of its own.
        assert name.split(" ")[1].startswith("/v1/") or name == "GET /metrics", name
        assert operation["description"], name
        assert "application/problem+json" in operation["responses"]["422"]["content"], name
        if "{" in name:
            assert "404" in operation["responses"], name


def test_outputs_have_every_field_always(api):
    for name, schema in api["components"]["schemas"].items():
        if name.endswith(("Out", "Page")):
            assert set(schema["required"]) == set(schema["properties"]), name
            assert schema["additionalProperties"] is False, name


def test_inputs_take_nothing_unknown(api):
    for name in ("PatientIn", "PatientChange", "SessionIn", "SessionLink"):
        assert api["components"]["schemas"][name]["additionalProperties"] is False, name


def test_numbers_say_what_they_count_or_their_unit(api):
    for name, schema in api["components"]["schemas"].items():
        if not name.endswith("Out"):
            continue
        for field, entry in schema["properties"].items():
            kinds = {option.get("type") for option in entry.get("anyOf", [entry])}
            if kinds & {"number", "integer"}:
                assert entry.get("description") or any(each.get("description") for each in entry["anyOf"]), (
                    name,
                    field,
                )


def test_every_reference_leads_somewhere(api):
    text = json.dumps(api)
    for name in {part.split('"')[0] for part in text.split('"#/components/schemas/')[1:]}:
        assert name in api["components"]["schemas"], name
