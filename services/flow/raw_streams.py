"""The streams that a source delivers, as its description says."""

from schemas.session import SessionDescription
from schemas.signals import IMU, REFERENCE, SKELETON
from services.flow.message import Stream

REFERENCE_STREAM = Stream(REFERENCE, "reference")


def raw_streams(description: SessionDescription) -> list[Stream]:
    """One per hub, one per camera, and the truth where there is any."""
    streams = [Stream(IMU, hub.name) for hub in description.hubs]
    streams += [Stream(SKELETON, camera.name) for camera in description.cameras]
    return streams + ([REFERENCE_STREAM] if description.reference else [])
