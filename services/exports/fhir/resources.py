"""What all resources share: identity, references, time."""

import re
import uuid
from datetime import UTC, datetime, timedelta

from schemas.session import SessionDescription
from schemas.vocabulary import Segment
from services.exports.fhir.codes import Json
from services.exports.fhir.source import FhirSource

NAMESPACE = uuid.UUID("a4d0c9b2-6e1f-5a3d-8b7c-9f2e4d6a8c55")
"""Of the UUIDs of resources: the same session gives the same ones, so a second import replaces and does not double."""


def resource_id(*words: str) -> str:
    """The UUID of what the words name."""
    return str(uuid.uuid5(NAMESPACE, "/".join(words)))


def full_url(resource_uuid: str) -> str:
    """Under which a resource stands in a bundle."""
    return f"urn:uuid:{resource_uuid}"


def reference(resource: Json) -> Json:
    """To a resource of the same bundle."""
    return {"reference": full_url(resource["id"]), "type": resource["resourceType"]}


def instant(time: datetime) -> str:
    """UTC with milliseconds."""
    return time.astimezone(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


def ended(source: FhirSource) -> datetime:
    """When the last thing was measured that the results rest on."""
    return source.began + timedelta(microseconds=source.metrics.captured_ns // 1000)


def without_names(text: str, description: SessionDescription) -> str:
    """A sentence without the names that somebody gave sensors, hubs and cameras: they could be anything."""
    spoken: dict[str, str] = {}
    for hub in description.hubs:
        spoken[hub.name] = "the receiver"
        for sensor in hub.sensors:
            spoken[sensor.name] = f"the sensor of {sensor.segment.replace('_', ' ')}"
    spoken |= {camera.name: "the camera" for camera in description.cameras}
    for name in sorted(spoken.keys() - set(Segment), key=len, reverse=True):
        text = re.sub(rf"(?<![\w-]){re.escape(name)}(?![\w-])", spoken[name], text)
    return text
