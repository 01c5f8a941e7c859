"""Entries of the audit as HL7 FHIR R4 AuditEvents."""

from services.exports.fhir.codes import PATIENT_CODES, SESSION_IDS, Json
from services.exports.fhir.resources import full_url, instant, resource_id
from services.gateway.audit.tables import AuditRow

ACCOUNTS = "urn:uuid:3b1f7c52-8d4e-5a6b-9e20-4c7d1a9f6e66"
OPERATIONS = "urn:uuid:91c4e0d7-2a5f-5b38-8c61-7f3e9d0b2a77"
_TERMINOLOGY = "http://terminology.hl7.org/CodeSystem"

_REST = {"system": f"{_TERMINOLOGY}/audit-event-type", "code": "rest", "display": "RESTful Operation"}
_PERSON = {"system": f"{_TERMINOLOGY}/audit-entity-type", "code": "1", "display": "Person"}
_THING = {"system": f"{_TERMINOLOGY}/audit-entity-type", "code": "2", "display": "System Object"}
_PATIENT = {"system": f"{_TERMINOLOGY}/object-role", "code": "1", "display": "Patient"}

_VERBS = {
    "C": ("create", "add", "start", "keep", "share"),
    "R": ("read", "list", "download", "search", "watch", "export", "verify", "live"),
    "U": ("change", "link", "choose", "mark", "merge", "restore", "put", "set", "stop", "renew"),
    "D": ("delete", "forget", "erase", "discard"),
}
CLIENT_ERROR, SERVER_ERROR = 400, 500


def audit_event(row: AuditRow) -> Json:
    """One entry. The same entry gives the same resource."""
    event = {
        "resourceType": "AuditEvent",
        "id": resource_id("audit", str(row.number), row.digest),
        "type": _REST,
        "subtype": [{"system": OPERATIONS, "code": row.action}],
        "action": _action(row.action),
        "recorded": instant(row.at),
        "outcome": "0" if row.outcome < CLIENT_ERROR else "4" if row.outcome < SERVER_ERROR else "8",
        "outcomeDesc": f"HTTP {row.outcome}",
        "agent": [_agent(row)],
        "source": {"observer": {"display": "Ambula gateway"}},
        "entity": _entities(row),
    }
    if row.reason is not None:
        event["purposeOfEvent"] = [{"text": row.reason.replace("_", " ")}]
    return event


def entry_of(resource: Json) -> Json:
    """A resource as it stands in a bundle."""
    return {"fullUrl": full_url(resource["id"]), "resource": resource}


def _action(operation: str) -> str:
    verb = operation.partition("_")[0]
    return next((letter for letter, verbs in _VERBS.items() if verb in verbs), "E")


def _agent(row: AuditRow) -> Json:
    who: Json = {"display": row.actor_kind}
    if row.actor is not None:
        who = {"identifier": {"system": ACCOUNTS, "value": row.actor}}
    role = {} if row.role is None else {"role": [{"text": row.role}]}
    return {"who": who, "requestor": True} | role


def _entities(row: AuditRow) -> list[Json]:
    detail = {"detail": [{"type": "sha256 of the chain", "valueString": row.digest}]}
    entities: list[Json] = [{"what": {"display": f"entry {row.number}"}, "type": _THING} | detail]
    if row.patient is not None:
        what = {"identifier": {"system": PATIENT_CODES, "value": row.patient}}
        entities.append({"what": what, "type": _PERSON, "role": _PATIENT})
    if row.session is not None:
        entities.append({"what": {"identifier": {"system": SESSION_IDS, "value": row.session}}, "type": _THING})
    if row.object is not None:
        entities.append({"what": {"display": row.object}, "type": _THING})
    return entities
