"""Whatever fits the published description, and what does not, asked of every operation as an administrator.

A few seeded examples with the other tests; `make fuzz-api` asks far more. Any answer must be one that is declared, as
it is declared, and never a mistake of the server.
"""

import os

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from schemathesis.checks import not_a_server_error
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)

from tests.unit.gateway.security.operations import operations

EXAMPLES = int(os.environ.get("AMBULA_FUZZ_EXAMPLES", "2"))
CHECKS = [not_a_server_error, status_code_conformance, content_type_conformance, response_schema_conformance]
EVERY_OPERATION = {each.name: (each.path, each.method) for each in operations()}


@pytest.fixture(scope="module")
def description(site):
    return schemathesis.openapi.from_asgi("/v1/openapi.json", site.app)


@pytest.mark.parametrize("name", EVERY_OPERATION)
def test_any_request(site, description, name):
    path, method = EVERY_OPERATION[name]
    site.put_back()

    @settings(
        max_examples=EXAMPLES, derandomize=EXAMPLES < 10, deadline=None, database=None, phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )  # fmt: skip
    @given(case=description[path][method].as_strategy())
    def ask(case):
        case.call_and_validate(headers=site.headers["site"], checks=CHECKS)

    ask()
