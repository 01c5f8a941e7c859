import re

import pytest

from schemas.signals import SIGNALS

UNIT = re.compile(
    r"\b(rad(/s(\^[23])?)?|m(/s(\^2)?)?|s|ns|kg|Hz|bytes|count|number of|dimensionless|share|steps per minute|SI units?"
    r"|unit|0 a guess|the worst sensor's quality|sequence|one stride is 2 pi|messages?)\b"
)


def numeric_fields(schema):
    for model in [schema, *schema.get("$defs", {}).values()]:
        for name, field in model.get("properties", {}).items():
            flat = str({key: value for key, value in field.items() if key not in ("description", "title")})
            if "'number'" in flat or "'integer'" in flat:
                yield model["title"], name, field


@pytest.mark.parametrize("signal", SIGNALS, ids=lambda signal: signal.name)
def test_every_number_states_its_unit(signal):
    for model, name, field in numeric_fields(signal.model.model_json_schema()):
        stated = name.endswith("_ns") or UNIT.search(field.get("description", ""))
        assert stated, f"{model}.{name} does not state its unit"
