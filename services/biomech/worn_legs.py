"""Legs that wear a sensor on thigh and shank."""

from collections.abc import Sequence
from typing import NamedTuple

from schemas.session import SensorDescription, SessionDescription
from schemas.vocabulary import Segment, Side

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


def _on(worn: Sequence[SensorDescription], segment: Segment) -> SensorDescription | None:
    return next((sensor for sensor in worn if sensor.segment is segment), None)
