"""Patient and Devices: a code instead of a person, and what measured and computed."""

from services.exports.fhir.codes import PATIENT_CODES, PSEUDONYMIZED, SESSION_IDS, Detail, Json, answer
from services.exports.fhir.resources import reference, resource_id
from services.exports.fhir.source import FhirSource, Subject

OLDEST_WITH_A_YEAR = 89
"""Years. Beyond it a year of birth alone can point to a person (HIPAA safe harbour, 45 CFR 164.514(b)(2)(i)(C))."""


def patient_resource(subject: Subject, year: int) -> Json:
    """Identifier, and the year of birth and sex where they are known. Nothing else is known here, least a name."""
    resource: Json = {
        "resourceType": "Patient",
        "id": resource_id("patient", subject.code),
        "meta": {"security": [PSEUDONYMIZED]},
        "identifier": [{"use": "usual", "system": PATIENT_CODES, "value": subject.code}],
    }
    if subject.sex is not None:
        resource["gender"] = str(subject.sex)
    if subject.year_of_birth is not None and year - subject.year_of_birth <= OLDEST_WITH_A_YEAR:
        resource["birthDate"] = f"{subject.year_of_birth:04d}"
    return resource


def device_resources(source: FhirSource) -> list[Json]:
    """The set of all, first; then each sensor, each camera and the software as parts of it."""
    session = source.description.session
    whole = {
        "resourceType": "Device",
        "id": resource_id(session, "device set"),
        "identifier": [{"system": SESSION_IDS, "value": session}],
        "deviceName": [{"name": device_set(source), "type": "other"}],
        "type": answer(Detail.DEVICE, "device_set"),
    }
    parts = [
        _part(whole, session, "inertial_sensor", f"inertial sensor, {sensor.segment.replace('_', ' ')}", str(number))
        for number, sensor in enumerate(sensor for hub in source.description.hubs for sensor in hub.sensors)
    ]
    parts += [
        _part(whole, session, "depth_camera", f"depth camera, {camera.kind.replace('_', ' ')}", str(number))
        for number, camera in enumerate(source.description.cameras)
    ]
    name, _, version = source.metrics.software.partition(" ")
    software = _part(whole, session, "software", name, source.metrics.software)
    return [whole, *parts, software | {"version": [{"value": version or name}]}]


def device_set(source: FhirSource) -> str:
    """What is worn and what watches, in words of the vocabulary only."""
    segments = [
        sensor.segment.replace("_", " ") for hub in source.description.hubs for sensor in hub.sensors
    ]  # fmt: skip
    said = [f"{len(segments)} inertial sensors: {', '.join(segments)}"] if segments else []
    said += [f"depth camera: {camera.kind.replace('_', ' ')}" for camera in source.description.cameras]
    return "; ".join(said)


def _part(whole: Json, session: str, kind: str, name: str, distinct: str) -> Json:
    return {
        "resourceType": "Device",
        "id": resource_id(session, kind, distinct),
        "deviceName": [{"name": name, "type": "other"}],
        "type": answer(Detail.DEVICE, kind),
        "parent": reference(whole),
    }
