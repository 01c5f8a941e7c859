"""Synthetic walks in which the stride does not go on as it was: stumbles, and sitting down between the walks.

Only motions of the benchmark: a stumble here is a jolt at hip and knee of one leg while the stride skips ahead; the
feet are not careful about the ground.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from services.ingest.synthetic import SyntheticWalk, WalkParameters
from services.ingest.synthetic.gait import Gait, Strides
from services.ingest.synthetic.jets import Jet, smooth_step

FloatArray = NDArray[np.float64]

STUMBLE_EVERY_S, STUMBLE_S = 12.0, 0.35
SKIPPED = (-0.12, 0.3)
"""Strides by which the phase is elsewhere after a stumble."""
REGAINED_S = 4.0
"""s over which the walker falls back into the old beat."""
JOLT = (0.15, 0.5)
"""rad of the jolt at hip and knee, either way."""
SEATED_HIP, SEATED_KNEE = 1.4, 1.5
"""rad, sitting on a chair."""
SIT_S = (3.0, 3.8)
"""s from sitting down to the next; regular enough to be taken for a rhythm."""


@dataclass(frozen=True)
class Jolt:
    """An excursion of some joints: rad by name, from zero and back to it within `length_s`."""

    start_s: float
    length_s: float
    excursion: dict[str, float]
    held_s: float = 0.0

    def at(self, time_s: FloatArray) -> Jet:
        """0, 1 for `held_s` in the middle, 0."""
        clock = Jet(time_s, np.ones_like(time_s), np.zeros_like(time_s))
        flank_s, end_s = (self.length_s - self.held_s) / 2, self.start_s + self.length_s
        rise = clock.through(smooth_step(self.start_s, self.start_s + flank_s))
        return rise + clock.through(smooth_step(end_s - flank_s, end_s)).scaled(-1.0)


class DisturbedStrides(Strides):
    """Strides with what comes on top of their joint angles, or in the place of some."""

    extra: dict[str, Jet]
    replaces: bool = False


class DisturbedGait(Gait):
    """A gait whose joints obey disturbances too."""

    def angles(self, strides: Strides) -> dict[str, Jet]:
        """As of the undisturbed gait, with the strides' `extra`."""
        found = super().angles(strides)
        if isinstance(strides, DisturbedStrides):
            for name, extra in strides.extra.items():
                found[name] = extra if strides.replaces else found[name] + extra
        return found


class DisturbedWalk(SyntheticWalk):
    """A walk with stumbles, or with sitting down and standing up in its pauses."""

    def __init__(self, parameters: WalkParameters, *, stumbles: bool = False, sits: bool = False) -> None:
        super().__init__(parameters)
        gait = self.gait
        self.gait = DisturbedGait(gait.thigh_length, gait.shank_length, gait.hip_width, gait.asymmetry)
        rng = np.random.default_rng([parameters.seed, 9])
        self.skips: list[tuple[float, float]] = []
        self.jolts: list[Jolt] = []
        if stumbles:
            self._plan_stumbles(rng)
        if sits:
            self._plan_sitting(rng)

    def _plan_stumbles(self, rng: np.random.Generator) -> None:
        for bout in self.timeline.bouts:
            start_s = bout.start_s + 10.0 + rng.uniform(0.0, STUMBLE_EVERY_S)
            while start_s + REGAINED_S + 2.0 < bout.end_s:
                side = rng.choice(["right", "left"])
                excursion = {
                    f"{joint}_flexion_{side}": float(rng.choice([-1.0, 1.0]) * rng.uniform(*JOLT))
                    for joint in ("hip", "knee")
                }
                self.jolts.append(Jolt(start_s, STUMBLE_S, excursion))
                self.skips.append((start_s, float(rng.uniform(*SKIPPED))))
                start_s += STUMBLE_EVERY_S * rng.uniform(0.7, 1.3)

    def _plan_sitting(self, rng: np.random.Generator) -> None:
        bouts, excursion = self.timeline.bouts, dict[str, float]()
        for side in ("right", "left"):
            excursion |= {f"hip_flexion_{side}": SEATED_HIP, f"knee_flexion_{side}": SEATED_KNEE}
        for before, after in pairwise(bouts):
            start_s = before.end_s + 1.0
            while start_s + SIT_S[1] < after.start_s:
                length_s = float(rng.uniform(*SIT_S))
                self.jolts.append(Jolt(start_s, 0.9 * length_s, excursion, 0.15 * length_s))
                start_s += length_s

    def strides(self, time_s: FloatArray) -> Strides:
        """Where the walker is, stumbles included."""
        plain, phase = super().strides(time_s), super().strides(time_s).phase
        clock = Jet(time_s, np.ones_like(time_s), np.zeros_like(time_s))
        for start_s, skipped in self.skips:
            end_s = start_s + 1.2 * STUMBLE_S
            phase = phase + clock.through(smooth_step(start_s, end_s)).scaled(skipped)
            phase = phase + clock.through(smooth_step(end_s, end_s + REGAINED_S)).scaled(-skipped)
        strides = DisturbedStrides(phase, plain.amplitude, plain.heading)
        zero = Jet.constant(0.0, time_s)
        strides.extra = {}
        for jolt in self.jolts:
            for name, angle in jolt.excursion.items():
                strides.extra[name] = strides.extra.get(name, zero) + jolt.at(time_s).scaled(angle)
        return strides

    def disturbed(self, time_s: FloatArray, after_s: float = 1.0) -> NDArray[np.bool_]:
        """(n,) during a stumble or a sit, and a while after."""
        within = [(time_s >= jolt.start_s) & (time_s < jolt.start_s + jolt.length_s + after_s) for jolt in self.jolts]
        return np.any(within, axis=0) if within else np.zeros(len(time_s), dtype=np.bool_)
