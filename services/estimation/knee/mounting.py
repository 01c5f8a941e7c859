"""What the description says of how a sensor is worn: the body's left and up the segment, in the sensor's axes."""

import numpy as np
from numpy.typing import NDArray

from schemas.session import Placement, SensorDescription

Array = NDArray[np.float64]


def upward(sensor: SensorDescription) -> Array | None:
    """Up the segment, a unit vector (3,); None where any direction may be up."""
    return None if sensor.upward_axis is None else _unit(sensor.upward_axis)


def leftward(sensor: SensorDescription) -> Array | None:
    """The person's left, a unit vector (3,); None where it was not said.

    Out of the skin for a sensor on the outer side of the left leg or the inner side of the right one. Left = up x
    forward, and outward is forward for a sensor in front.
    """
    outward = _unit(sensor.outward_axis)
    if sensor.placement in (Placement.LATERAL, Placement.MEDIAL):
        is_left = sensor.segment.value.endswith("left")
        return outward if is_left == (sensor.placement is Placement.LATERAL) else -outward
    up = upward(sensor)
    if up is None or sensor.placement is Placement.UNKNOWN:
        return None
    left = np.cross(up, outward if sensor.placement is Placement.ANTERIOR else -outward)
    return _unit(left.tolist()) if np.linalg.norm(left) > 0.2 else None


def _unit(direction: list[float]) -> Array:
    vector = np.array(direction, dtype=np.float64)
    return np.asarray(vector / np.linalg.norm(vector))
