"""Back to the plain filter when the sensors contradict the rhythm (named as future work by Joukov et al.).

A simpler filter runs beside a bolder one on the same samples: plain beside rhythmic. With s = e' inv(C) e + log det C
of each, e the innovation and C its covariance (twice the negative log likelihood of the sample),

    d = s_simple - s_bold,   t = <d> / sqrt(<d^2> / n)

over a sliding memory of n samples is how sure the samples are that the bolder filter predicts better (t > 0) or worse.
The estimate goes over to the simple filter as t falls from `doubt` to `refusal`, and back when it rises again, which
it can because the bolder filter goes on by itself in the meantime.

Where both have the same process noise their covariances and gains are all but the same, so that in a large filter the
second one need be no more than a second state.
"""

from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from services.biomech.rhythm.phase_loop import clip
from services.biomech.single_joint.compiled import compiled

FloatArray = NDArray[np.float64]

MEAN, POWER = range(2)
"""Slots of the evidence (2,), no unit."""


@dataclass(frozen=True)
class InnovationGate:
    """Tunables of the fall-back.

    It stands behind the gate by lock quality (`phase_loop.jerk_gate`), which alone lets through about one run in a
    hundred of aimless smooth motion with up to 1.3 times the error of the plain filter. Where there is a period it
    changes nothing.
    """

    memory_s: float = 1.0
    """s of the sliding mean."""
    doubt: float = 0.5
    """t below which the rhythm loses weight. With it above 0 the rhythm has to earn its place."""
    refusal: float = -0.5
    """t at which it has none."""


@compiled
def bold_share(
    evidence: FloatArray, simple: float, bold: float, dt_s: float, memory_s: float, doubt: float, refusal: float
) -> float:
    """Weight of the bolder estimate, 0 to 1, from s of both filters; follows the evidence."""
    difference = simple - bold
    gain = dt_s / memory_s
    evidence[MEAN] += gain * (difference - evidence[MEAN])
    evidence[POWER] += gain * (difference * difference - evidence[POWER])
    # An exponential mean with gain k weighs as much as 2 / k samples.
    sureness = evidence[MEAN] / sqrt(evidence[POWER] * gain / 2.0 + 1e-12)
    return clip((sureness - refusal) / (doubt - refusal), 0.0, 1.0)
