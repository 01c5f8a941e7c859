"""Whether a bolder estimate has predicted the samples better than a simpler one beside it.

With d the difference of both in -2 log likelihood of a sample (positive: the bolder one was better) and <> a sliding
mean of n samples,

    t = <d> / sqrt(<d^2> / n)

is how sure the samples are. The estimate goes over to the simpler one as t falls from `doubt` to `refusal`, and back
when it rises again, which it can because the bolder one goes on by itself in the meantime.
"""

import numpy as np

from services.biomech.kernels.compiled import kernel
from services.biomech.kernels.tables import Array

MEAN, POWER = range(2)
"""Slots of the evidence (2,)."""


@kernel
def bold_share(evidence: Array, difference: float, dt_s: float, memory_s: float, doubt: float, refusal: float) -> float:
    """Weight of the bolder estimate, 0 to 1; `evidence` follows the difference d."""
    gain = min(dt_s / memory_s, 1.0)
    evidence[MEAN] += gain * (difference - evidence[MEAN])
    evidence[POWER] += gain * (difference * difference - evidence[POWER])
    # An exponential mean with gain k weighs as much as 2 / k samples.
    sureness = evidence[MEAN] / np.sqrt(evidence[POWER] * gain / 2.0 + 1e-12)
    share: float = min(max((sureness - refusal) / (doubt - refusal), 0.0), 1.0)
    return share
