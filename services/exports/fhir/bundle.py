"""A session as one Bundle (collection) of HL7 FHIR R4, the version that most systems of clinics read."""

from services.exports.fhir.codes import SESSION_IDS, Json
from services.exports.fhir.documents import diagnostic_report, recording_document
from services.exports.fhir.observations import conditions_observation, metric_observations, shared_by_all
from services.exports.fhir.people_and_devices import device_resources, patient_resource
from services.exports.fhir.resources import ended, full_url, instant, resource_id
from services.exports.fhir.source import FhirSource

MEDIA_TYPE = "application/fhir+json"


def bundle(source: FhirSource) -> Json:
    """Patient, Devices, recording, Observations, DiagnosticReport. The same results give the same bundle.

    Free text that somebody typed (title, names of sensors) is not in it.
    """
    subject = None if source.subject is None else patient_resource(source.subject, source.began.year)
    devices = device_resources(source)
    recording = None if source.recording is None else recording_document(source, source.recording, subject)
    shared = shared_by_all(subject, devices, recording)
    results = [conditions_observation(source, shared), *metric_observations(source, shared)]
    report = diagnostic_report(source, results, subject)
    resources = [*([] if subject is None else [subject]), *devices]
    resources += [*([] if recording is None else [recording]), *results, report]
    return {
        "resourceType": "Bundle",
        "id": resource_id(source.description.session, "bundle"),
        "identifier": {"system": SESSION_IDS, "value": source.description.session},
        "type": "collection",
        "timestamp": instant(ended(source)),
        "entry": [{"fullUrl": full_url(resource["id"]), "resource": resource} for resource in resources],
    }
