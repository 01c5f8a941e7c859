"""What our bundles may hold: resource types, their elements, the codes at each place. Anything else is a mistake."""

from collections.abc import Mapping

from services.definitions.table import BY_NAME
from services.exports.fhir.codes import (
    ABSENT,
    CATEGORY,
    DETAILS,
    DIAGNOSTIC_SECTION,
    DISPLAYS,
    EXACT,
    LOINC,
    METRICS,
    OBSERVATION_VALUE,
    SNOMED,
)

ELEMENTS: Mapping[str, frozenset[str]] = {
    "Patient": frozenset({"meta", "identifier", "gender", "birthDate"}),
    "Device": frozenset({"identifier", "deviceName", "type", "parent", "version"}),
    "DocumentReference": frozenset(
        {"identifier", "status", "docStatus", "type", "subject", "date", "description", "content"}
    ),
    "Observation": frozenset(
        {"status", "category", "code", "subject", "effectivePeriod", "issued", "valueQuantity", "dataAbsentReason",
         "bodySite", "device", "derivedFrom", "component"}
    ),
    "DiagnosticReport": frozenset(
        {"identifier", "status", "category", "code", "subject", "effectivePeriod", "issued", "result", "conclusion",
         "presentedForm"}
    ),
}  # fmt: skip
"""Beside `resourceType` and `id`. No element that holds a name, an address or a narrative is among them."""

REQUIRED: Mapping[str, frozenset[str]] = {
    "Patient": frozenset({"identifier", "meta"}),
    "Device": frozenset({"type", "deviceName"}),
    "DocumentReference": frozenset({"status", "content", "type"}),
    "Observation": frozenset({"status", "category", "code", "effectivePeriod", "device", "component"}),
    "DiagnosticReport": frozenset({"status", "category", "code", "effectivePeriod", "issued", "result", "conclusion"}),
}

STATUSES: Mapping[str, frozenset[str]] = {
    "DocumentReference": frozenset({"current"}),
    "Observation": frozenset({"preliminary", "final"}),
    "DiagnosticReport": frozenset({"preliminary", "final"}),
}
"""Of the standard's codes those that we may say; nobody here amends or cancels."""

POINTS_TO: Mapping[str, frozenset[str]] = {
    "subject": frozenset({"Patient"}),
    "device": frozenset({"Device"}),
    "parent": frozenset({"Device"}),
    "derivedFrom": frozenset({"DocumentReference"}),
    "result": frozenset({"Observation"}),
}

CODES: Mapping[str, frozenset[str]] = {
    METRICS: frozenset(BY_NAME),
    DETAILS: frozenset(DISPLAYS),
    SNOMED: frozenset(coding["code"] for coding in EXACT.values() if coding["system"] == SNOMED),
    LOINC: frozenset(coding["code"] for coding in EXACT.values() if coding["system"] == LOINC),
    CATEGORY: frozenset({"procedure"}),
    DIAGNOSTIC_SECTION: frozenset({"PT"}),
    OBSERVATION_VALUE: frozenset({"PSEUDED"}),
    ABSENT: frozenset({"unknown", "unsupported"}),
}
"""Every system and its codes that may stand anywhere. Codes of answers (LOINC `LA...`) are in none of them."""

SYSTEMS_AT: Mapping[str, frozenset[str]] = {
    "Observation.category": frozenset({CATEGORY}),
    "Observation.code": frozenset({METRICS, DETAILS, SNOMED, LOINC}),
    "Observation.bodySite": frozenset({DETAILS}),
    "Observation.dataAbsentReason": frozenset({ABSENT}),
    "Observation.component.code": frozenset({DETAILS}),
    "Observation.component.valueCodeableConcept": frozenset({DETAILS}),
    "Observation.component.dataAbsentReason": frozenset({ABSENT}),
    "DiagnosticReport.category": frozenset({DIAGNOSTIC_SECTION}),
    "DiagnosticReport.code": frozenset({DETAILS}),
    "DocumentReference.type": frozenset({DETAILS}),
    "Device.type": frozenset({DETAILS}),
    "Patient.meta.security": frozenset({OBSERVATION_VALUE}),
}
"""Which systems a place takes its codes from."""

VALUES = ("valueQuantity", "valueCodeableConcept", "valueInteger", "valueString", "valueBoolean")
