"""Synthetic exercises of a knee: somebody who sits, lies, squats or cycles, and walks nowhere. Pure.

The foot of the other leg stays flat on the floor and the pelvis goes where that leg lets it: it is still while the
other leg rests, and goes down with the knees in a squat. On a bicycle the saddle holds the pelvis.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

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
from services.ingest.synthetic.parameters import KneeParameters
from services.ingest.synthetic.pedals import Pedals
from services.ingest.synthetic.rigid import BodyMotion, PointMotion
from services.ingest.synthetic.sensors import LEFT_LEG
from services.ingest.synthetic.session import SyntheticSession
from services.ingest.synthetic.tempo import OwnPace
from services.ingest.synthetic.timeline import Timeline

TREMOR_HZ = 5.0
"""Hz, in the middle of what resting and action tremors are seen to have (4 to 6)."""
REPETITION_CHANNEL = "repetition"
"""Channel of truth: the number of the repetition from 1, negative where it is partial, 0 in none."""


@dataclass(frozen=True)
class ExercisingBody(Gait):
    """A body that stands on one foot or, without `stands_on`, is held by a saddle."""

    stands_on: Side | None = None

    def _supports(self, hung: dict[Segment, BodyMotion], strides: Strides) -> list[tuple[Jet, PointMotion]]:
        if self.stands_on is None:
            return []
        foot = hung[Segment(f"foot_{self.stands_on}")].point(BALL_FROM_ANKLE)
        return [(Jet.constant(1.0, strides.phase.value), foot)]


class SyntheticKnee(SyntheticSession):
    """A rest, then repetitions with rests between the sets."""

    task = Task.KNEE_FLEXION
    own_channels = (REPETITION_CHANNEL,)

    def __init__(self, parameters: KneeParameters) -> None:
        self.exercise = Exercise(parameters.exercise)
        self.side = Side.LEFT if parameters.worn == LEFT_LEG else Side.RIGHT
        """Whose knee the repetitions are counted of."""
        self.protocol = IN_WORDS[self.exercise]
        self.title = f"Synthetic {self.protocol} (seed {parameters.seed})"
        if self.exercise is Exercise.CYCLING:
            parameters = replace(parameters, hold=0.0, breath=0.0, hesitations=0.0, partials=0.0)
        self.dials = parameters
        self.plan = KneePlan.of(parameters)
        self.reach = parameters.range or DEFAULT_RANGE[self.exercise]
        self.least = parameters.deficit or LEAST_FLEXION[self.exercise]
        lengths = parameters.thigh_length, parameters.shank_length, parameters.hip_width
        stands_on = None if self.exercise is Exercise.CYCLING else self.side.other
        body = ExercisingBody(*lengths, stands_on=stands_on)
        super().__init__(parameters, Timeline((), (), 1.0, OwnPace.drawn(1.0, 0.0, parameters.seed)), body)
        self._pedals = Pedals.of(self.plan, parameters.duration)
        self._tremor = parameters.tremor

    @property
    def repetitions(self) -> tuple[TrueRepetition, ...]:
        """Those that are truly made."""
        return self.plan.repetitions

    def amplitude(self, time_s: Array) -> Jet:
        """Nobody walks."""
        return Jet.constant(0.0, time_s)

    def strides(self, time_s: Array) -> Strides:
        """Standing on the spot, and how far the body is from upright."""
        return super().strides(time_s)._replace(posture=self._posture(time_s))

    def own_truth(self, time_s: Array) -> Array:
        """The repetition of each instant, (n, 1)."""
        return self.plan.numbers(time_s)[:, None]

    def soft_tissue(self, strides: Strides) -> tuple[Jet, Jet]:
        """The skin slides as the knee bends: once and twice per whole turn of the knee."""
        knee = strides.posture[f"knee_flexion_{self.side}"]
        return knee.scaled(1 / (2 * math.pi)), Jet.constant(1.0, knee.value)

    def _posture(self, time_s: Array) -> dict[str, Jet]:
        """Joint angles, rad: a thigh inclined by a over a pelvis tilted by t has hip flexion a + t."""
        shaking = self._shaking(time_s)
        if self.exercise is Exercise.CYCLING:
            legs = {side: self._pedalling(time_s, 0.0 if side is self.side else 0.5) for side in Side}
            tilt = Jet.constant(SADDLE_TILT, time_s)
        else:
            away = self.plan.away(time_s)
            moving, tilt = self._leg(away)
            resting, _ = self._leg(Jet.constant(0.0, time_s))
            legs = {self.side: moving, self.side.other: resting if self.exercise in ONE_LEG else moving}
        into = self.plan.in_position(time_s)
        found = {"pelvis_tilt": tilt * into}
        for side, leg in legs.items():
            found[f"hip_flexion_{side}"] = (leg.thigh + tilt) * into
            found[f"knee_flexion_{side}"] = (leg.knee + shaking if side is self.side else leg.knee) * into
        return found

    def _leg(self, away: Jet) -> tuple[Leg, Jet]:
        most = self.least + self.reach
        if self.exercise in RESTS_FLEXED:
            knee = away.scaled(-self.reach).shifted(most)
        else:
            knee = away.scaled(self.reach).shifted(self.least)
        return posture(self.exercise, knee, most, (self.gait.thigh_length, self.gait.shank_length))

    def _pedalling(self, time_s: Array, ahead: float) -> Leg:
        turns = self._pedals.turns(time_s).shifted(ahead)
        return pedalling(turns, self._pedals.size(time_s), self.least, self.reach)

    def _shaking(self, time_s: Array) -> Jet:
        angular = 2 * math.pi * TREMOR_HZ
        sine, cosine = np.sin(angular * time_s), np.cos(angular * time_s)
        return Jet(sine, angular * cosine, -(angular**2) * sine).scaled(self._tremor)
