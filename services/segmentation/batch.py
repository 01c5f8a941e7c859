"""The samples of one message, as every segmenter takes them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import BODY_MODELS, LOWER_BODY, Segment

Array = NDArray[np.float64]

DOFS = len(LOWER_BODY)
COLUMNS = tuple(dict.fromkeys(dof.name for dof in (*LOWER_BODY, *BODY_MODELS["whole_body"])))
"""Every joint coordinate of any model: those of the lower body, then what the whole body adds."""
INDEX = {name: i for i, name in enumerate(COLUMNS)}
"""Column of each joint coordinate by name."""


@dataclass(frozen=True, slots=True)
class Centres:
    """Joint centres at the same samples, in the order of JointCentre, in the axes of the camera's room."""

    position: Array  # (n, 15, 3) m
    seen: NDArray[np.bool_]  # (15,)


@dataclass(frozen=True, slots=True)
class Batch:
    """Joint coordinates in the order of INDEX. `phase` is NaN without a lock; no message carries it.

    d is DOFS for a lower body and all of COLUMNS for a whole one; what that model lacks of them is 0 and not valid.
    """

    captured_ns: NDArray[np.int64]  # (n,)
    position: Array  # (n, d) rad
    velocity: Array  # (n, d) rad/s
    phase: Array  # (n,) rad
    position_std: Array  # (n, d) rad
    valid: NDArray[np.bool_]  # (d,)
    observed: frozenset[Segment]  # segments with a sensor of their own
    centres: Centres | None = None  # where a camera sees the body
