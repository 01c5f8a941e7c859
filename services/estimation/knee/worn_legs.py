"""Legs that wear a sensor on thigh and shank, and what becomes of all other sensors."""

from collections.abc import Sequence
from typing import NamedTuple

from schemas.session import SensorDescription, SessionDescription
from schemas.vocabulary import Segment, Side
from services.estimation.intake import Used

SIDES = (Side.RIGHT, Side.LEFT)
"""Order of the legs, as in the joint coordinates."""


class WornLeg(NamedTuple):
    """A leg and its sensors, thigh first."""

    side: Side
    sensors: tuple[SensorDescription, SensorDescription]

    @property
    def segments(self) -> tuple[Segment, Segment]:
        """Thigh and shank."""
        return self.sensors[0].segment, self.sensors[1].segment


def worn_legs(description: SessionDescription) -> list[WornLeg]:
    """Legs with a sensor on thigh and shank; of two on one segment the first counts."""
    worn = [sensor for hub in description.hubs for sensor in hub.sensors]
    legs = []
    for side in SIDES:
        thigh, shank = (_on(worn, Segment(f"{part}_{side}")) for part in ("thigh", "shank"))
        if thigh is not None and shank is not None:
            legs.append(WornLeg(side, (thigh, shank)))
    return legs


def used_by_knees(description: SessionDescription) -> Used:
    """Sensors of the worn legs, leg by leg, thigh first."""
    worn = [sensor for hub in description.hubs for sensor in hub.sensors]
    used = [sensor for leg in worn_legs(description) for sensor in leg.sensors]
    unused = {sensor.name: _why_unused(sensor.segment) for sensor in worn if sensor not in used}
    return Used(used, len(used), unused)


def _on(worn: Sequence[SensorDescription], segment: Segment) -> SensorDescription | None:
    return next((sensor for sensor in worn if sensor.segment is segment), None)


def _why_unused(segment: Segment) -> str:
    place = segment.value.replace("_", " ")
    if segment.value.startswith(("thigh", "shank")):
        return (
            f"a knee needs one sensor on the thigh and one on the shank; this one on the {place} is alone or a second"
        )
    return f"the knee needs no sensor on the {place}"
