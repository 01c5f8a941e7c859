"""The report as it is printed, and where the recording lies: samples stay in MCAP, FHIR carries a link."""

import base64
import hashlib

from services.exports.fhir.codes import PHYSICAL_THERAPY, SESSION_IDS, Detail, Json, detail
from services.exports.fhir.resources import ended, instant, reference, resource_id
from services.exports.fhir.source import FhirSource, PrintedReport, Recorded

NOT_FOR_DIAGNOSIS = "Computed by research software. Not a medical device, not for diagnosis."


def recording_document(source: FhirSource, recording: Recorded, subject: Json | None) -> Json:
    """A DocumentReference to the session's MCAP files."""
    resource: Json = {
        "resourceType": "DocumentReference",
        "id": resource_id(source.description.session, "recording"),
        "identifier": [{"system": SESSION_IDS, "value": source.description.session}],
        "status": "current",
        "docStatus": "final" if source.metrics.final else "preliminary",
        "type": detail(Detail.RECORDING),
        "date": instant(ended(source)),
        "content": [{"attachment": {"contentType": "application/vnd.mcap", "url": recording.url}}],
    }
    if recording.sha256 is not None:
        resource["description"] = f"SHA-256 of the raw recording: {recording.sha256}"
    return resource if subject is None else resource | {"subject": reference(subject)}


def diagnostic_report(source: FhirSource, results: list[Json], subject: Json | None) -> Json:
    """What holds the Observations together, with the printed report where there is one."""
    at = instant(ended(source))
    resource: Json = {
        "resourceType": "DiagnosticReport",
        "id": resource_id(source.description.session, "report"),
        "identifier": [{"system": SESSION_IDS, "value": source.description.session}],
        "status": "final" if source.metrics.final else "preliminary",
        "category": [{"coding": [PHYSICAL_THERAPY]}],
        "code": detail(Detail.REPORT),
        "effectivePeriod": {"start": instant(source.began), "end": at},
        "issued": at,
        "result": [reference(result) for result in results],
        "conclusion": NOT_FOR_DIAGNOSIS,
    }
    if source.report is not None:
        resource["presentedForm"] = [_attachment(source.report, at)]
    return resource if subject is None else resource | {"subject": reference(subject)}


def _attachment(report: PrintedReport, created: str) -> Json:
    return {
        "contentType": "application/pdf",
        "language": report.language,
        "data": base64.b64encode(report.pdf).decode("ascii"),
        "size": len(report.pdf),
        # FHIR R4 asks for SHA-1; it guards against damage, not against forgery.
        "hash": base64.b64encode(hashlib.sha1(report.pdf, usedforsecurity=False).digest()).decode("ascii"),
        "title": "Movement report",
        "creation": created,
    }
