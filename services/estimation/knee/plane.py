"""The sagittal plane of two sensors: where their flexion axes and the directions up the segments are given."""

from math import atan2
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Plane(NamedTuple):
    """Unit vectors (2, 3) in the frame of each sensor, thigh first."""

    axes: Array  # flexion axis: the person's left
    along: Array  # up the segment, across the axis
    across: Array  # axis x along

    def tilts(self, up: Array) -> tuple[float, float]:
        """Angles, rad, of both segments about the axis, from the verticals up (2, 3) in their sensors, of any length.

        From a segment that turned by +a the vertical is seen turned by -a.
        """
        thigh, shank = (atan2(-float(u @ c), float(u @ x)) for u, c, x in zip(up, self.across, self.along, strict=True))
        return thigh, shank


def plane_of(axes: Array, references: Array) -> Plane:
    """From flexion axes and directions up the segments (2, 3), whose part along the axis does not matter."""
    unit = axes / np.linalg.norm(axes, axis=1)[:, None]
    along = references - np.sum(references * unit, axis=1)[:, None] * unit
    along = along / np.linalg.norm(along, axis=1)[:, None]
    return Plane(unit, along, np.cross(unit, along))
