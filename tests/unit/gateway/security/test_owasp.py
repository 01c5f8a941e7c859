"""OWASP API Security Top 10 (2023), row by row: what proves each. Tests that are named here must exist."""

import ast
import json
import re
from http import HTTPStatus
from pathlib import Path

import jsonschema
import pytest

from services.gateway.access.rules import NoRule, check_rules
from services.gateway.access.scope import EVERYTHING
from services.gateway.audit.tables import AuditRow
from services.gateway.openapi_file import FILE
from tests.unit.gateway.security.operations import DOCUMENT, operations, resolved
from tests.unit.gateway.security.test_matrix import request_of

ROOT = Path(__file__).parents[4]
GATEWAY = ROOT / "services" / "gateway"
HERE = "tests/unit/gateway"

PROVED = {
    "1 object level": {
        f"{HERE}/security/test_matrix.py": ["test_operation", "test_live_connection", "test_live_floor"],
        f"{HERE}/security/test_scope.py": ["test_no_query_reads_what_is_not_in_scope"],
    },
    "2 authentication": {
        f"{HERE}/accounts/oidc/test_refusals.py": ["test_a_token_that_the_service_did_not_sign"],
        f"{HERE}/accounts/test_browsers.py": [
            "test_an_old_secret_ends_the_sign_in_for_thief_and_owner_and_is_in_the_audit",
        ],
        f"{HERE}/accounts/test_signing_in.py": [
            "test_guessing_closes_an_account_for_longer_each_time",
            "test_whether_a_name_exists_is_not_told_by_the_work_that_is_done",
            "test_the_cost_of_nobodys_password_is_that_of_somebodys",
            "test_few_wait_for_their_turn_so_that_others_are_answered",
        ],
    },
    "3 property level": {
        f"{HERE}/security/test_owasp.py": ["test_unknown_and_read_only_fields", "test_answers_hold_what_is_declared"],
    },
    "4 resources": {
        f"{HERE}/security/test_limits.py": [
            "test_one_sign_in_is_refused_before_its_address_is", "test_no_page_limit_is_above_a_hundred",
            "test_one_clinic_does_not_take_every_live_connection", "test_the_third_report_at_once_is_told_to_wait",
            "test_headers_that_do_not_come_end_the_connection", "test_a_body_that_does_not_come_to_an_end_is_refused",
            "test_a_live_connection_takes_no_large_message",
            "test_a_flood_is_answered_and_the_live_connection_goes_on",
        ],
        f"{HERE}/test_security.py": ["test_large_bodies_are_refused_announced_or_not"],
        f"{HERE}/test_slow_browser.py": [
            "test_the_stalled_browser_is_dropped_and_the_other_sees_everything_go_on",
        ],
    },
    "5 function level": {f"{HERE}/security/test_owasp.py": ["test_a_route_without_a_rule_does_not_start"]},
    "6 business flows": {f"{HERE}/security/test_owasp.py": ["test_what_cannot_be_undone"]},
    "7 SSRF": {f"{HERE}/security/test_owasp.py": ["test_no_address_is_taken_from_a_request"]},
    "8 misconfiguration": {
        f"{HERE}/test_security.py": ["test_every_answer_has_the_headers", "test_no_foreign_site_is_invited"],
        f"{HERE}/test_tls.py": ["test_the_page_over_tls", "test_without_tls_browsers_are_told_nothing_of_it"],
    },
    "9 inventory": {
        f"{HERE}/test_openapi.py": ["test_the_published_description_is_that_of_the_code"],
        f"{HERE}/security/test_owasp.py": ["test_every_path_is_versioned_and_described"],
    },
    "10 unsafe consumption": {
        "tests/unit/gateway/test_live.py": ["test_garbage_on_the_way_is_counted_and_the_rest_goes_on"],
    },
}  # fmt: skip


@pytest.mark.parametrize("row", PROVED)
def test_row(row):
    for file, names in PROVED[row].items():
        tree = ast.parse((ROOT / file).read_text())
        there = {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}
        assert set(names) - there == set(), file


OPERATIONS = {each.name: each for each in operations()}
WITH_BODY = [name for name, each in OPERATIONS.items() if each.body_schema is not None]
READ_ONLY = ("id", "created", "clinic_id", "deleted", "unexpected")
"""Never to be said by whoever asks: the server decides these."""


@pytest.mark.parametrize("name", WITH_BODY)
def test_unknown_and_read_only_fields(site, name):
    operation = OPERATIONS[name]
    address, body = request_of(site, operation, "own")
    for field in READ_ONLY:
        if field in operation.body_schema["properties"]:
            continue
        changed = {**body, field: "x"}
        answer = site.client.request(operation.method, address, json=changed, headers=site.headers["site"])
        assert answer.status_code == HTTPStatus.UNPROCESSABLE_ENTITY, (field, answer.text)
        assert any(fault["where"].endswith(field) for fault in answer.json()["faults"]), (field, answer.text)


def test_inputs_are_closed_all_the_way_down():
    for name in WITH_BODY:
        for where, schema in parts(OPERATIONS[name].body_schema, name):
            if schema.get("type") == "object" and "properties" in schema:
                assert schema.get("additionalProperties") is False, where


def parts(schema, where, seen=()):
    """A schema and everything inside of it."""
    schema = resolved(schema)
    yield where, schema
    inner = {**schema.get("properties", {}), **dict(enumerate(schema.get("anyOf", ())))}
    if "items" in schema:
        inner["items"] = schema["items"]
    for name, each in inner.items():
        if each.get("$ref") not in seen:
            yield from parts(each, f"{where}.{name}", (*seen, each.get("$ref")))


JSON_READINGS = [
    name
    for name, each in OPERATIONS.items()
    if each.method == "GET" and "application/json" in each.described["responses"].get("200", {}).get("content", {})
]


@pytest.mark.parametrize("name", JSON_READINGS)
def test_answers_hold_what_is_declared(site, name):
    operation = OPERATIONS[name]
    declared = operation.described["responses"]["200"]["content"]["application/json"]["schema"]
    address, _ = request_of(site, operation, "own")
    answer = site.client.get(address, headers=site.headers["admin"])
    assert answer.status_code == HTTPStatus.OK, answer.text
    schema = {**declared, "components": DOCUMENT["components"]}
    jsonschema.Draft202012Validator(schema).validate(answer.json())


def test_a_route_without_a_rule_does_not_start(site):
    @site.app.get("/v1/forgotten")
    def forgotten() -> None: ...

    route = site.app.router.routes.pop()
    with pytest.raises(NoRule, match="/v1/forgotten"):
        check_rules([route])


CANNOT_BE_UNDONE = [name for name in OPERATIONS if name.endswith(("/erasure", "/merge")) or "audit/export" in name]


@pytest.mark.parametrize("name", [name for name in CANNOT_BE_UNDONE if name.startswith("POST")])
def test_what_cannot_be_undone(site, name):
    operation = OPERATIONS[name]
    address, body = request_of(site, operation, "own")
    assert "reason" in operation.body_schema["required"]
    without = {key: value for key, value in body.items() if key != "reason"}
    headers = site.headers["admin"]
    assert site.client.post(address, json=without, headers=headers).status_code == HTTPStatus.UNPROCESSABLE_ENTITY
    site.forget_confirmations()
    answer = site.client.post(address, json=body, headers=headers)
    assert (answer.status_code, answer.json()["title"]) == (HTTPStatus.FORBIDDEN, "Confirm your password")
    site.put_back()
    assert site.client.post(address, json=body, headers=headers).is_success
    with site.app.state.gateway.database.transaction(EVERYTHING) as rows:
        entries = rows.query(AuditRow).filter(AuditRow.reason == body["reason"]).all()
    site.put_back()
    assert ("K7QM3F", site.accounts["admin"]) in [(entry.patient, entry.actor) for entry in entries]


def test_no_address_is_taken_from_a_request():
    # No field of a request is an address of anything outside, and only signing in elsewhere asks another host: the
    # one in the settings.
    for name, operation in OPERATIONS.items():
        inputs = dict(parts(operation.body_schema, name)) if operation.body_schema is not None else {}
        inputs |= {f"{name}?{key}": each["schema"] for key, each in operation.query.items()}
        for where, schema in inputs.items():
            assert schema.get("format") not in ("uri", "url", "uri-reference", "hostname", "ipv4", "ipv6"), where
            assert not re.search(r"(^|_)(url|uri|host|webhook|callback|endpoint)$", where.rpartition(".")[2]), where
    clients = ("urllib.request", "http.client", "httpx", "httpx2", "requests", "aiohttp", "socket", "smtplib", "ftplib")
    asking = {
        path.relative_to(GATEWAY).as_posix()
        for path in GATEWAY.rglob("*.py")
        if "web" not in path.relative_to(GATEWAY).parts
        if re.search(rf"^\s*(import|from) ({'|'.join(map(re.escape, clients))})\b", path.read_text(), re.MULTILINE)
    }
    assert asking == {"accounts/oidc/fetching.py"}


def test_every_path_is_versioned_and_described(site):
    described = json.loads(FILE.read_text())["paths"].keys()
    assert {path for path in described if not path.startswith("/v1/")} <= {"/metrics"}
    served = {route.path for route in site.app.routes if hasattr(route, "dependant")}
    undescribed = served - described
    assert undescribed == {"/", "/docs", "/favicon.ico"}
