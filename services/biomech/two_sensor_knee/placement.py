"""Sensors worn otherwise than declared, told from where the knee lies and where the flexion axis points."""

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import Misplacement, Side
from services.biomech.rotations import normalised

Array = NDArray[np.float64]

CLEAR_M = 0.05
"""m by which the knee must lie on the wrong side of a sensor."""
CLEAR_SHARE = 0.5
"""Share of a direction (60 degrees) that must point the wrong way."""


def are_swapped(arms: Array, up: Array) -> bool:
    """Whether the knee lies above the thigh's sensor and below the shank's.

    Args:
        arms: from each sensor to the knee, (2, 3) m in the frame of the sensor, thigh first.
        up: the vertical in each sensor, (2, 3), while the leg hangs or stands.
    """
    above = np.sum(arms * up, axis=1)
    return bool(above[0] > CLEAR_M and above[1] < -CLEAR_M)


def is_upside_down(up: Array, declared_up: Array) -> bool:
    """Whether a sensor's vertical (3,) points against the direction (3,) that was declared to be up."""
    return float(normalised(up) @ normalised(declared_up)) < -CLEAR_SHARE


def leg_worn_on(flexion_axis: Array, outward: Array) -> Side | None:
    """The leg of a sensor on its outer side; None for a sensor that is worn in front or behind.

    Args:
        flexion_axis: (3,) in the sensor, positive when the knee bends. The shank goes backwards, so it points left.
        outward: (3,) out of the skin, in the sensor.
    """
    leftward = float(normalised(flexion_axis) @ normalised(outward))
    if abs(leftward) < CLEAR_SHARE:
        return None
    return Side.LEFT if leftward > 0.0 else Side.RIGHT


def misplacements(
    arms: Array, up: Array, axes: Array, declared_up: Array, outward: Array, side: Side
) -> tuple[Misplacement, ...]:
    """All that is seen to differ from the declaration.

    Args:
        arms, up, axes: of `KneeAxis`, (2, 3), while standing.
        declared_up, outward: (2, 3) directions in each sensor that should point up, and out of the skin.
        side: the leg that was declared.
    """
    found = [Misplacement.SWAPPED] if are_swapped(arms, up) else []
    names = (Misplacement.THIGH_UPSIDE_DOWN, Misplacement.SHANK_UPSIDE_DOWN)
    found += [name for name, seen, wanted in zip(names, up, declared_up, strict=True) if is_upside_down(seen, wanted)]
    legs = {leg_worn_on(axis, out) for axis, out in zip(axes, outward, strict=True)} - {None}
    if legs and side not in legs:
        found.append(Misplacement.OTHER_LEG)
    return tuple(found)
