"""Pedals that turn once for each repetition: where they are, and how far the knee goes. Pure."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicSpline

from services.ingest.synthetic.jets import Array, Jet
from services.ingest.synthetic.knee_plan import KneePlan, TrueRepetition
from services.ingest.synthetic.tempo import jet_of


@dataclass(frozen=True)
class Pedals:
    """Turns without a rest between them are one smooth run, which begins and ends at rest."""

    runs: tuple[tuple[float, float, CubicSpline], ...]  # start s, end s, turns over s
    sizes: CubicSpline  # share of the full range over s

    @classmethod
    def of(cls, plan: KneePlan, duration_s: float) -> "Pedals":
        """One turn for each repetition of the plan."""
        runs = tuple(
            (float(at[0]), float(at[-1]), CubicSpline(at, done + np.arange(len(at)), bc_type="clamped"))
            for done, at in _runs(plan.repetitions)
        )
        knots = [(0.0, 1.0), *((made.turn_s, made.reach) for made in plan.repetitions), (duration_s + 1.0, 1.0)]
        at, reach = zip(*knots, strict=True)
        return cls(runs, CubicSpline(at, reach, bc_type="clamped"))

    def turns(self, time_s: Array) -> Jet:
        """Since the start of the session; stands still between the runs."""
        turns = Jet.constant(0.0, time_s)
        for start_s, end_s, spline in self.runs:
            run = jet_of(spline, np.clip(time_s, start_s, end_s))
            turning, begun = (time_s > start_s) & (time_s < end_s), time_s > start_s
            turns = Jet(
                np.where(begun, run.value, turns.value),
                np.where(turning, run.rate, turns.rate),
                np.where(turning, run.acceleration, turns.acceleration),
            )
        return turns

    def size(self, time_s: Array) -> Jet:
        """How far the knee goes, as a share of its full range."""
        return jet_of(self.sizes, time_s)


def _runs(repetitions: tuple[TrueRepetition, ...]) -> list[tuple[int, np.ndarray[tuple[int], np.dtype[np.float64]]]]:
    """Turns made before each run, and when its turns begin and the last one ends, s."""
    breaks = [i + 1 for i, (one, next_one) in enumerate(pairwise(repetitions)) if next_one.start_s > one.end_s]
    found = []
    for first, last in pairwise([0, *breaks, len(repetitions)]):
        run = repetitions[first:last]
        if run:
            found.append((first, np.array([*(made.start_s for made in run), run[-1].end_s])))
    return found
