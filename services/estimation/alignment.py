"""How the sensors of a session sit on their segments, as far as it is known."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Alignment:
    """R_segment_from_sensor (S, 3, 3), quality (S,) and which sensors have one (S,)."""

    R_segment_from_sensor: Array
    quality: Array
    aligned: NDArray[np.bool_]

    def first(self, count: int) -> "Alignment":
        """The same of the first sensors only."""
        return Alignment(self.R_segment_from_sensor[:count], self.quality[:count], self.aligned[:count])
