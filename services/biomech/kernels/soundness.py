"""Whether an estimate can still be one of a body."""

import numpy as np
from numpy.typing import NDArray

from services.biomech.kernels.compiled import strict_kernel

Array = NDArray[np.float64]


@strict_kernel
def is_sound(x: Array, companions: Array, variances: Array, first_rotation: int, fastest: float) -> bool:
    """Finite throughout, and no joint of x (3, n) or of companions (C, 3, n) as fast as `fastest` (rad/s).

    Variances are (m,). Translations, before `first_rotation`, drift where no sensor sees them and need only be finite.
    """
    total = 0.0
    for row in range(x.shape[0]):
        for joint in range(x.shape[1]):
            total += abs(x[row, joint])
    for c in range(companions.shape[0]):
        for row in range(companions.shape[1]):
            for joint in range(companions.shape[2]):
                total += abs(companions[c, row, joint])
    for i in range(variances.shape[0]):
        total += abs(variances[i])
    if not np.isfinite(total):
        return False
    for joint in range(first_rotation, x.shape[1]):
        if abs(x[1, joint]) >= fastest:
            return False
        for c in range(companions.shape[0]):
            if abs(companions[c, 1, joint]) >= fastest:
                return False
    return True
