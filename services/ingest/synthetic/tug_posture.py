"""How a synthetic person's joints get from the chair to upright and back, beside any striding. Pure.

Both feet stay flat on the ground and carry the body, so the pelvis goes forward and up as thighs and shanks turn.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from schemas.vocabulary import Side
from services.ingest.synthetic.gait import HEEL_FROM_ANKLE
from services.ingest.synthetic.jets import Array, Jet, smooth_step
from services.ingest.synthetic.parameters import TugParameters
from services.ingest.synthetic.tempo import jet_of
from services.ingest.synthetic.tug_plan import RiseParts, SitParts, TugPlan

HIP_OVER_SEAT_M = 0.08
"""Height of the hip centre over the seat."""
SEATED_TILT = -0.2
"""rad, the pelvis leans back on a chair."""
SEATED_SHANK_LEAN = 0.12
"""rad, knees ahead of the ankles: feet are drawn back to rise."""
RISING_TILT, SITTING_TILT = 0.35, 0.45
"""rad, how far the pelvis leans forward beyond its way between sitting and standing."""
RISING_SHANK_LEAN = 0.2
"""rad, how much further the knees go forward while the body is lifted."""


@dataclass(frozen=True)
class Posture:
    """Added joint angles of one session."""

    plan: TugPlan
    seated_thigh: float  # rad, thighs' inclination forward on the chair
    restlessness: CubicSpline  # rad over s

    @classmethod
    def of(cls, parameters: TugParameters, plan: TugPlan, restlessness: CubicSpline) -> "Posture":
        """On a chair whose height, with the length of the legs, decides how far the thighs are from level."""
        knee_m = parameters.shank_length * math.cos(SEATED_SHANK_LEAN) - float(HEEL_FROM_ANKLE[1])
        drop = (parameters.seat_height + HIP_OVER_SEAT_M - knee_m) / parameters.thigh_length
        return cls(plan, math.acos(min(0.6, max(-0.2, drop))), restlessness)

    def angles(self, time_s: Array) -> dict[str, Jet]:
        """rad by degree of freedom.

        With the thighs inclined by a, the shanks leaning forward by b and the pelvis tilted by t, hip flexion is
        a + t and knee flexion a + b.
        """
        clock = Jet(time_s, np.ones_like(time_s), np.zeros_like(time_s))
        first = 1.0 if self.plan.starts_seated else 0.0
        seated, settled = Jet.constant(first, time_s), Jet.constant(first, time_s)
        lean, shank = Jet.constant(0.0, time_s), Jet.constant(0.0, time_s)

        def step(span: tuple[float, float], size: float = 1.0) -> Jet:
            return clock.through(smooth_step(*span)).scaled(size)

        for change in self.plan.changes:
            if change.rises:
                rise = RiseParts.of(change, self.plan.lead)
                seated = seated + step(rise.thigh, -1.0)
                settled = settled + step(rise.forward, -1.0)
                lean = lean + step(rise.forward, RISING_TILT) + step(rise.back, -RISING_TILT)
                middle_s = (rise.thigh[0] + rise.thigh[1]) / 2
                shank = shank + step((rise.thigh[0], middle_s)) + step((middle_s, rise.thigh[1]), -1.0)
            else:
                sit = SitParts.of(change)
                seated, settled = seated + step(sit.thigh), settled + step(sit.back)
                lean = lean + step(sit.forward, SITTING_TILT) + step(sit.back, -SITTING_TILT)
        thigh = seated.scaled(self.seated_thigh)
        shank = seated.scaled(SEATED_SHANK_LEAN) + shank.scaled(RISING_SHANK_LEAN)
        tilt = settled.scaled(SEATED_TILT) + lean + jet_of(self.restlessness, time_s) * settled
        found = {"pelvis_tilt": tilt}
        for side in Side:
            found |= {f"hip_flexion_{side}": thigh + tilt, f"knee_flexion_{side}": thigh + shank}
        return found
