"""Sensors that single knees use, and what becomes of all others."""

from schemas.session import SessionDescription
from schemas.vocabulary import Segment
from services.biomech.worn_legs import worn_legs
from services.estimation.intake import Used


def used_by_knees(description: SessionDescription) -> Used:
    """Sensors of the worn legs, leg by leg, thigh first."""
    worn = [sensor for hub in description.hubs for sensor in hub.sensors]
    used = [sensor for leg in worn_legs(description) for sensor in leg.sensors]
    unused = {sensor.name: _why_unused(sensor.segment) for sensor in worn if sensor not in used}
    return Used(used, len(used), unused)


def _why_unused(segment: Segment) -> str:
    place = segment.value.replace("_", " ")
    if segment.value.startswith(("thigh", "shank")):
        return (
            f"a knee needs one sensor on the thigh and one on the shank; this one on the {place} is alone or a second"
        )
    return f"the knee needs no sensor on the {place}"
