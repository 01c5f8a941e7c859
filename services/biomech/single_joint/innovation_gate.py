"""Back to the plain filter when the sensors contradict the rhythm (named as future work by Joukov et al.).

A simpler filter runs beside a bolder one on the same samples: plain beside rhythmic. With s = e' inv(C) e + log det C
of each, e the innovation and C its covariance (twice the negative log likelihood of the sample), the difference of both
is the evidence for the bolder one (`kernels/evidence.py`).

Where both have the same process noise their covariances and gains are all but the same, so that in a large filter the
second one need be no more than a second state (`kernels/companions.py`).
"""

from dataclasses import dataclass


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
