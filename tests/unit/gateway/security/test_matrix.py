"""Every operation and live connection x everybody x everything: the published permission and the scope, exactly.

What an operation needs is in its `x-permission`; who has that is in `access/roles.py`. Only what goes beyond the two is
written down here. An operation that no good request can be made for fails, so a new route fails until it is covered.
"""

import json

import pytest
from fastapi.routing import APIWebSocketRoute
from starlette.websockets import WebSocketDisconnect

from services.gateway.access.roles import MAY, Permission, Role
from services.gateway.routers import ROUTES
from tests.unit.gateway.security.operations import DOCUMENT, Operation, operations
from tests.unit.gateway.security.site import CALLERS, PASSWORD, ROLES, Site

OPERATIONS = {each.name: each for each in operations()}
WHOSE = {"code", "session"}
"""Names of path values that belong to a patient."""

ADMINISTERED = {"account", "key", "device", "clinic"}
"""Names of path values that belong to a clinic: neither shared nor in a bin."""

SITE_WIDE = {"account", "clinic"}
"""Those among them that a site's administrator reaches in every clinic."""

FOR_SITE_ADMINISTRATORS = {"POST /v1/clinics"}
"""Ask for more than their permission: somebody who manages all clinics."""

FOR_PEOPLE = {
    "POST /v1/sign-in/renewal", "POST /v1/sign-in/confirmation", "PUT /v1/me/password", "DELETE /v1/me/sign-ins",
    "GET /v1/colleagues", "GET /v1/patients/{code}/shares", "POST /v1/patients/{code}/shares",
    "DELETE /v1/patients/{code}/shares/{account}",
}  # fmt: skip
"""Refuse a machine's key although its role has the permission."""

NOT_OF_SHARED = {
    "DELETE /v1/patients/{code}", "DELETE /v1/sessions/{session}", "PUT /v1/patients/{code}/name",
    "DELETE /v1/patients/{code}/name", "POST /v1/patients/{code}/erasure", "POST /v1/patients/{code}/merge",
    "PATCH /v1/patients/{code}", "GET /v1/patients/{code}/shares", "POST /v1/patients/{code}/shares",
    "DELETE /v1/patients/{code}/shares/{account}",
}  # fmt: skip
"""What only a patient's own clinic may do, whoever else sees them."""

OF_THE_BIN = {"POST /v1/bin/patients/{code}/restoration", "POST /v1/bin/sessions/{session}/restoration"}
"""Of what lies in the own clinic's bin, and there is nothing else in it."""

ALSO_FROM_THE_BIN = {"POST /v1/patients/{code}/erasure"}
"""Of what lies in the own clinic's bin as well."""

PATHS = {
    "/v1/bin/sessions/{session}/restoration": {"session": "thrown"},
    "/v1/sessions/{session}/stop": {"session": "running"},
    "/v1/sessions/{session}/marks": {"session": "running"},
    "/v1/patients/{code}/shares/{account}": {"account": "seer"},
}
"""Path values that are not the target's value of the same name."""

NOBODYS = {"language": "en", "provider": "clinic"}
FILES = {
    "/v1/fhir/CodeSystem/{name}": "metrics",
    "/v1/sessions/{session}/recordings/{name}": "derived-0.1.0.mcap",
    "/v1/sessions/{session}/exports/{name}": "events.csv",
}
"""What `name` is in a path."""

ABOUT = {
    "POST /v1/sessions": {"patient": "code"},
    "PATCH /v1/sessions/{session}": {"patient": "code"},
    "PUT /v1/patients/{code}/baseline": {"session": "session"},
    "POST /v1/patients/{code}/merge": {"into": "other code"},
}
"""Body fields that name a patient or a session, and whose value of the target they have."""

BODIES = ABOUT | {
    "POST /v1/patients/{code}/shares": {"account": "guest"},
    "POST /v1/directory/names": {"codes": "codes"},
}
"""All body fields that have a value of the target."""

LITERALLY = {
    "POST /v1/accounts": {"password": PASSWORD},
    "PATCH /v1/accounts/{account}": {"disabled": True},
    "POST /v1/clinics": {"id": "south"},
    "PATCH /v1/clinics/{clinic}": {"keep_days": 30},
    "PATCH /v1/devices/{device}": {"note": "strap mended"},
    "PATCH /v1/patients/{code}": {"sex": "male"},
}
"""Body fields that are neither required nor good as they stand in the description."""

TELLS_OF_ALL = {"GET /v1/audit", "GET /v1/audit/export"}
"""Hold the codes that were asked for in vain, as they were asked for."""

MARKED_IN_BIN = {"GET /v1/bin"} | OF_THE_BIN

MARKERS = {
    "shared": ("SHARED9", "-shared", "Shared"),
    "foreign": ("THEIRS9", "-foreign", "Foreign"),
    "binned": ("BINNED9", "-binned"),
}


def may(operation: Operation, caller: str) -> int | None:
    """The status a caller is refused with, whatever it is about; None when they pass."""
    if operation.permission is None:
        return None
    if caller == "nobody":
        return 401
    role = Role.ADMIN if caller == "site" else Role(caller)
    if role not in MAY[Permission(operation.permission)]:
        return 403
    if operation.name in FOR_SITE_ADMINISTRATORS and caller != "site":
        return 403
    return 403 if operation.name in FOR_PEOPLE and caller == "service" else None


def expected(operation: Operation, caller: str, target: str) -> set[int]:
    """The statuses that are right."""
    refused = may(operation, caller)
    if refused is not None:
        return {refused}
    if operation.name in ALSO_FROM_THE_BIN and target == "binned":
        return {200}
    if operation.name in OF_THE_BIN:
        return {200, 201, 202, 204} if target == "binned" else {404}
    if target == "own" or (target == "shared" and caller != "service" and operation.name not in NOT_OF_SHARED):
        return {200, 201, 202, 204}
    if caller == "site" and operation.path_names & SITE_WIDE and not operation.path_names & WHOSE:
        return {200, 201, 202, 204}
    return {403} if target == "shared" and caller != "service" else {404}


def targets(operation: Operation) -> tuple[str, ...]:
    if operation.path_names & WHOSE:
        return ("own", "shared", "foreign", "binned")
    return ("own", "foreign") if operation.path_names & ADMINISTERED else ("own",)


def request_of(site: Site, operation: Operation, target: str) -> tuple[str, object]:
    """Address and body of a good request about the target."""
    values = site.targets[target].values
    named = {name: values[value] for name, value in PATHS.get(operation.path, {}).items()}
    named |= {"name": FILES[operation.path]} if operation.path in FILES else {}
    fields = {field: values[value] for field, value in BODIES.get(operation.name, {}).items()}
    return operation.address({**values, **NOBODYS, **named}), operation.body(LITERALLY.get(operation.name, {}) | fields)


def ask(site: Site, operation: Operation, caller: str, target: str):
    address, body = request_of(site, operation, target)
    answer = site.client.request(operation.method, address, json=body, headers=site.headers[caller])
    if operation.method != "GET" and answer.is_success:
        site.put_back()
    return answer


@pytest.mark.parametrize("name", OPERATIONS)
def test_operation(site, name):
    operation = OPERATIONS[name]
    wrong = []
    # Where nothing is administered, a site's administrator is an administrator.
    callers = CALLERS if operation.permission in (None, Permission.ADMINISTER) else CALLERS[:-1]
    for caller in callers:
        for target in targets(operation):
            answer = ask(site, operation, caller, target)
            right = expected(operation, caller, target) if operation.permission else declared(operation)
            if answer.status_code not in right:
                wrong.append(f"{caller} about {target}: {answer.status_code}, not {right}: {answer.text[:200]}")
            about = "binned" if name in MARKED_IN_BIN else target
            read = leaks(answer, caller, about) if name not in TELLS_OF_ALL else []
            wrong += [f"{caller} about {target} reads {each}" for each in read]
    assert wrong == []


def declared(operation: Operation) -> set[int]:
    return {int(status) for status in operation.described["responses"] if status < "500"}


def leaks(answer, caller: str, target: str) -> list[str]:
    """Marks of what the caller may not see in the body of an answer that is not about it."""
    if not answer.is_success:
        return []
    hidden = [kind for kind in MARKERS if kind != target and (kind != "shared" or caller == "service")]
    return [mark for kind in hidden for mark in MARKERS[kind] if mark.encode() in answer.content]


def test_what_is_not_to_be_seen_looks_like_what_does_not_exist(site):
    for path, absent in (("/v1/patients/{}", "N0WHERE9"), ("/v1/sessions/{}", "over-nowhere")):
        key = "code" if "patients" in path else "session"
        for caller in ROLES:
            plain = site.client.get(path.format(absent), headers=site.headers[caller])
            for target in ("foreign", "binned"):
                name = site.targets[target].values[key]
                answer = site.client.get(path.format(name), headers=site.headers[caller])
                assert answer.text.replace(name, absent) == plain.text


@pytest.mark.parametrize("name", [name for name in ABOUT if name in OPERATIONS])
def test_bodies_name_nobody_out_of_scope(site, name):
    operation = OPERATIONS[name]
    address, body = request_of(site, operation, "own")
    for target in ("foreign", "binned"):
        foreign = {field: site.targets[target].values[value] for field, value in ABOUT[name].items()}
        answer = site.client.request(operation.method, address, json=body | foreign, headers=site.headers["admin"])
        assert answer.status_code == 404, (target, answer.text)


def test_every_body_that_names_somebody_is_tried():
    naming = {"code", "codes", "patient", "session", "into"}
    fields = {name: naming & set((each.body_schema or {}).get("properties", ())) for name, each in OPERATIONS.items()}
    named = {name for name, found in fields.items() if found and OPERATIONS[name].permission}
    assert named - {"POST /v1/directory/names"} == ABOUT.keys() & OPERATIONS.keys()


def test_names_are_told_of_nobody_out_of_scope(site):
    for caller in ("therapist", "admin"):
        for target in ("foreign", "binned"):
            body = {"codes": site.targets[target].values["codes"]}
            answer = site.client.post("/v1/directory/names", json=body, headers=site.headers[caller])
            assert answer.json()["items"] == []


def test_lists_hold_nothing_out_of_scope_also_when_it_is_asked_for(site):
    for path in ("/v1/sessions?patient=THEIRS9", "/v1/sessions?patient=BINNED9"):
        for caller in ROLES:
            assert site.client.get(path, headers=site.headers[caller]).json() == {"total": 0, "items": []}


def test_the_matrix_has_every_operation_of_the_code(site):
    assert site.app.openapi()["paths"] == DOCUMENT["paths"]


SOCKETS = [route.path for route in ROUTES if isinstance(route, APIWebSocketRoute)]


def test_the_live_connections_are_these():
    assert SOCKETS == ["/v1/live", "/v1/live/{session}"]


@pytest.fixture(scope="module")
def running(site):
    """A running session of each patient."""
    from tests.unit.gateway.walk import describe

    for target in site.targets.values():
        site.hub.open(describe(target.values["running"]))
        site.hub.assign(target.values["running"], target.code, target.clinic)
    return site


@pytest.mark.parametrize("caller", CALLERS)
@pytest.mark.parametrize("target", ["own", "shared", "foreign", "nowhere"])
def test_live_connection(running, caller, target):
    session = "nowhere" if target == "nowhere" else running.targets[target].values["running"]
    seen = caller != "nobody" and (target == "own" or (target == "shared" and caller != "service"))
    with running.client.websocket_connect(f"/v1/live/{session}", headers=running.headers[caller]) as socket:
        if seen:
            assert json.loads(socket.receive_text())["id"] == session
        else:
            with pytest.raises(WebSocketDisconnect) as closed:
                socket.receive_text()
            assert closed.value.code == (4401 if caller == "nobody" else 4404)


@pytest.mark.parametrize("caller", CALLERS)
def test_live_floor(running, caller):
    with running.client.websocket_connect("/v1/live", headers=running.headers[caller]) as socket:
        if caller == "nobody":
            with pytest.raises(WebSocketDisconnect) as closed:
                socket.receive_text()
            assert closed.value.code == 4401
            return
        cards = {card["id"] for card in json.loads(socket.receive_text())["sessions"]}
    own, shared = (running.targets[name].values["running"] for name in ("own", "shared"))
    assert cards - {running.targets["binned"].values["running"]} == ({own} if caller == "service" else {own, shared})
