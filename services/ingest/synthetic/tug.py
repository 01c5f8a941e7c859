"""The synthetic timed up and go. Pure."""

from dataclasses import replace

import numpy as np

from schemas.vocabulary import TASK_PHASES, Task
from services.ingest.errors import InvalidOption
from services.ingest.synthetic.gait import Gait, Strides
from services.ingest.synthetic.jets import Array, Jet
from services.ingest.synthetic.parameters import TugParameters
from services.ingest.synthetic.session import SyntheticSession
from services.ingest.synthetic.tempo import random_spline
from services.ingest.synthetic.tug_plan import TruePhase, plan_tug
from services.ingest.synthetic.tug_posture import Posture

PHASE_CHANNEL = "task_phase"
"""Channel of truth: 0 in no phase, else the number of the phase in TASK_PHASES, from 1."""
FIDGET_S = 1.5
"""s from one restless movement of a seated person to the next."""


class SyntheticTug(SyntheticSession):
    """Quiet standing, sitting down, then the test as often as asked for."""

    protocol = "timed up and go"
    task = Task.TIMED_UP_AND_GO
    own_channels = (PHASE_CHANNEL,)

    def __init__(self, parameters: TugParameters) -> None:
        self.plan = plan_tug(parameters)
        least_s = self.plan.end_s
        if 0 < parameters.duration < least_s:
            raise InvalidOption(f"duration={parameters.duration:g} is too short; all attempts take {least_s:.1f} s")
        parameters = replace(parameters, duration=parameters.duration or least_s)
        gait = Gait(parameters.thigh_length, parameters.shank_length, parameters.hip_width, parameters.asymmetry)
        super().__init__(parameters, self.plan.timeline, gait)
        self.walkway_m = parameters.walkway
        self.title = f"Synthetic timed up and go at {parameters.speed:g} m/s (seed {parameters.seed})"
        self.amplitude_of_walk = self.amplitude_at(parameters.speed)
        rng = np.random.default_rng([parameters.seed, 6])
        self.posture = Posture.of(
            parameters, self.plan, random_spline(parameters.fidget, FIDGET_S, parameters.duration, rng)
        )

    @property
    def phases(self) -> tuple[TruePhase, ...]:
        """Where the phases of each attempt truly are."""
        return self.plan.phases

    def amplitude(self, time_s: Array) -> Jet:
        """As in a walk."""
        return self.timeline.amplitude(time_s).scaled(self.amplitude_of_walk)

    def strides(self, time_s: Array) -> Strides:
        """Striding, and how far the body is from upright."""
        return super().strides(time_s)._replace(posture=self.posture.angles(time_s))

    def own_truth(self, time_s: Array) -> Array:
        """The phase of the test at each instant."""
        phase = np.zeros_like(time_s)
        for number, kind in enumerate(TASK_PHASES[Task.TIMED_UP_AND_GO], start=1):
            for true in self.plan.phases:
                if true.phase is kind:
                    phase[(time_s >= true.start_s) & (time_s < true.end_s)] = number
        return phase[:, None]
