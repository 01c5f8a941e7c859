import json

import jsonschema
import pytest

from schemas.imu import ImuBatch, SensorSamples
from schemas.signals import SIGNALS
from services.cli.publish_schemas import PUBLISHED, schema_texts


def test_published_schemas_equal_the_code():
    committed = {path.name: path.read_text() for path in PUBLISHED.glob("*.json")}
    assert committed == schema_texts(), "run `make schemas` and review the difference"


@pytest.mark.parametrize("text", schema_texts().values(), ids=schema_texts().keys())
def test_published_schema_is_a_valid_json_schema(text):
    jsonschema.Draft202012Validator.check_schema(json.loads(text))


def test_a_real_message_meets_its_published_schema():
    batch = ImuBatch(
        sensors=[SensorSamples(captured_ns=[1], angular_velocity=[[0, 0, 0]], specific_force=[[0, 9.8, 0]])],
        marks=[],
    )
    schema = json.loads((PUBLISHED / "imu.schema.json").read_text())
    jsonschema.validate(json.loads(batch.model_dump_json()), schema)


@pytest.mark.parametrize("signal", SIGNALS, ids=lambda signal: signal.name)
def test_no_field_has_a_default(signal):
    """Absent and null are different things; a default would blur them."""
    schema = signal.model.model_json_schema()
    for model in [schema, *schema.get("$defs", {}).values()]:
        if model.get("type") == "object" and "properties" in model:
            assert set(model.get("required", ())) == set(model["properties"]), model["title"]
