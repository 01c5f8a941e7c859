"""The samples of one message, as every segmenter takes them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import LOWER_BODY, Segment

Array = NDArray[np.float64]

INDEX = {dof.name: i for i, dof in enumerate(LOWER_BODY)}
"""Column of each joint coordinate by name."""
DOFS = len(INDEX)


@dataclass(frozen=True, slots=True)
class Batch:
    """Joint coordinates in the order of INDEX. `phase` is NaN without a lock; no message carries it."""

    captured_ns: NDArray[np.int64]  # (n,)
    position: Array  # (n, 15) rad
    velocity: Array  # (n, 15) rad/s
    phase: Array  # (n,) rad
    position_std: Array  # (n, 15) rad
    valid: NDArray[np.bool_]  # (15,)
    observed: frozenset[Segment]  # segments with a sensor of their own
