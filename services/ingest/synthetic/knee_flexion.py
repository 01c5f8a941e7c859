"""Synthetic exercises of a knee: somebody who sits, lies, squats or cycles, and walks nowhere. Pure.

The foot of the other leg stays flat on the floor and the pelvis goes where that leg lets it: it is still while the
other leg rests, and goes down with the knees in a squat. On a bicycle the saddle holds the pelvis.
"""

import math
from collections.abc import Mapping

import numpy as np
from scipy.interpolate import CubicSpline

from schemas.vocabulary import Segment, Side, Task
from services.ingest.synthetic.gait import BALL_FROM_ANKLE, Gait, Strides
from services.ingest.synthetic.jets import Array, Jet
from services.ingest.synthetic.knee_plan import KneePlan, TrueRepetition
from services.ingest.synthetic.knee_postures import (
    DEFAULT_RANGE,
    IN_WORDS,
    LEAST_FLEXION,
    ONE_LEG,
    RESTS_FLEXED,
    SADDLE_TILT,
    Exercise,
    Leg,
    pedalling,
    posture,
)
from services.ingest.synthetic.parameters import LEFT_LEG, KneeParameters
from services.ingest.synthetic.rigid import BodyMotion, PointMotion
from services.ingest.synthetic.session import SyntheticSession
from services.ingest.synthetic.tempo import OwnPace, jet_of
from services.ingest.synthetic.timeline import RESTING_PHASE, Timeline

TREMOR_HZ = 5.0
"""Hz, in the middle of what resting and action tremors are seen to have (4 to 6)."""
REPETITION_CHANNEL = "repetition"
"""Channel of truth: the number of the repetition from 1, negative where it is partial, 0 in none."""


class ExercisingBody(Gait):
    """A body that stands on one foot, `stands_on`, or is held by a saddle (None)."""

    stands_on: Side | None = None

    def _supports(self, hung: dict[Segment, BodyMotion], strides: Strides) -> list[tuple[Jet, PointMotion]]:
        if self.stands_on is None:
            return []
        foot = hung[Segment(f"foot_{self.stands_on}")].point(BALL_FROM_ANKLE)
        return [(Jet.constant(1.0, strides.phase.value), foot)]


class SyntheticKnee(SyntheticSession):
    """A rest, then repetitions with rests between the sets."""

    task = Task.KNEE_FLEXION

    def __init__(self, parameters: KneeParameters) -> None:
        self.exercise = Exercise(parameters.exercise)
        self.side = Side.LEFT if parameters.worn == LEFT_LEG else Side.RIGHT
        self.protocol = IN_WORDS[self.exercise]
        self.title = f"Synthetic {self.protocol} (seed {parameters.seed})"
        self.plan = KneePlan.of(parameters)
        self.reach = parameters.range or DEFAULT_RANGE[self.exercise]
        self.least = parameters.deficit or LEAST_FLEXION[self.exercise]
        body = ExercisingBody(parameters.thigh_length, parameters.shank_length, parameters.hip_width)
        if self.exercise is not Exercise.CYCLING:
            object.__setattr__(body, "stands_on", self.side.other)
        super().__init__(parameters, Timeline((), (), 1.0, OwnPace.drawn(1.0, 0.0, parameters.seed)), body)
        self._tremor = parameters.tremor
