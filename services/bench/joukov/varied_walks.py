"""Synthetic walks whose strides differ as a person's do: optical strides at hips and knees, varied by 2 to 5 %."""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from services.bench.joukov.disturbed_walks import DisturbedGait, DisturbedStrides
from services.bench.rhythm.motions import INTERVAL_S, draw_cycles, leg_scale, play_cycles, walk_cycles
from services.bench.rhythm.stride_shapes import StrideShapes
from services.ingest.synthetic import SyntheticWalk, WalkParameters
from services.ingest.synthetic.gait import Strides
from services.ingest.synthetic.jets import Jet, smooth_step

FloatArray = NDArray[np.float64]

PLAYED = ("knee_flexion_left", "knee_flexion_right", "hip_flexion_left", "hip_flexion_right")
"""Columns of the stride shapes. Their thigh pitch is taken for hip flexion: the pelvis hardly tilts in walking."""
CADENCE_HZ = (0.6, 1.1)
VARIABILITY = (0.02, 0.05)
CYCLES_PER_CONTACT = 0.5
"""The shapes begin at a left contact, the stride phase at a right one."""


class VariedWalk(SyntheticWalk):
    """Quiet standing, then a walk without stops; of the parameters, neither speed nor turns nor asymmetry count."""

    def __init__(self, parameters: WalkParameters, shapes: StrideShapes) -> None:
        super().__init__(parameters)
        gait = self.gait
        self.gait = DisturbedGait(gait.thigh_length, gait.shank_length, gait.hip_width)
        rng = np.random.default_rng([parameters.seed, 10])
        variability = rng.uniform(*VARIABILITY)
        self._walked_s = np.arange(int(parameters.duration / INTERVAL_S) + 100) * INTERVAL_S
        wander = np.sin(2.0 * np.pi * self._walked_s / rng.uniform(15.0, 40.0) + rng.uniform(0.0, 6.28))
        nominal_hz = rng.uniform(*CADENCE_HZ) * (1.0 + 0.03 * wander)
        cycles = draw_cycles(rng, shapes, variability, leg_scale(rng))
        pace = 1.0 + variability * rng.standard_normal(len(cycles))
        turns, _ = walk_cycles(rng, nominal_hz, pace, np.ones(self._walked_s.size))
        self._turns = CubicSpline(self._walked_s, turns + CYCLES_PER_CONTACT)
        self._angles = CubicSpline(self._walked_s, play_cycles(turns, cycles))

    def strides(self, time_s: FloatArray) -> Strides:
        """Where the walker is."""
        walked_s = np.clip(time_s - self.parameters.standing, 0.0, self._walked_s[-1])
        clock = Jet(time_s, np.ones_like(time_s), np.zeros_like(time_s))
        walking = clock.through(smooth_step(self.parameters.standing, self.parameters.standing + 1.5))
        moves = walked_s > 0.0
        phase = Jet(self._turns(walked_s), *(np.where(moves, self._turns(walked_s, k), 0.0) for k in (1, 2)))
        strides = DisturbedStrides(phase, walking, Jet.constant(0.0, time_s))
        played = [self._angles(walked_s, k) for k in range(3)]
        strides.extra = {
            name: Jet(played[0][:, j], np.where(moves, played[1][:, j], 0.0), np.where(moves, played[2][:, j], 0.0))
            * walking
            for j, name in enumerate(PLAYED)
        }
        strides.replaces = True
        return strides
