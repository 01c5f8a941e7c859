"""When a synthetic person does the repetitions of a knee exercise, and how far each goes. Pure."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from services.ingest.synthetic.jets import Array, Jet, smooth_step
from services.ingest.synthetic.parameters import KneeParameters

SETTLING_S = 2.5
"""s from standing to the position in which the exercise rests."""
LEAST_MOVE_S = 0.5
"""s there and back, however high the tempo and long the holds."""
HALF_WAY_STOP_S = (0.5, 1.2)
"""s that a hesitation lasts, half-way out."""
PARTIAL_RANGE = (0.3, 0.42)
"""Share of its range that a partial repetition reaches."""


class TrueRepetition(NamedTuple):
    """One repetition; `moves` are (start s, end s, share of the full range by which the knee goes away from home)."""

    start_s: float
    turn_s: float
    """Middle of the hold."""
    end_s: float
    reach: float
    """Share of the full range."""
    is_partial: bool
    moves: tuple[tuple[float, float, float], ...]


@dataclass(frozen=True)
class KneePlan:
    """The schedule of one session."""

    settled_s: float
    """When the first rest begins; before it the person stands and gets into position."""
    repetitions: tuple[TrueRepetition, ...]

    @classmethod
    def of(cls, parameters: KneeParameters) -> "KneePlan":
        """Rest, then repetitions, with a rest after every set, until the time is up."""
        settled_s = parameters.standing + SETTLING_S if parameters.standing else 0.0
        rng = np.random.default_rng([parameters.seed, 7])
        starts_s = settled_s + parameters.rest
        made: list[TrueRepetition] = []
        while True:
            done = min(1.0, (starts_s - settled_s) / (parameters.duration - settled_s))
            repetition = _repetition(parameters, starts_s, done, rng)
            if repetition.end_s > parameters.duration - 1.0:
                return cls(settled_s, tuple(made))
            made.append(repetition)
            set_is_over = parameters.set_of and len(made) % parameters.set_of == 0
            starts_s = repetition.end_s + (parameters.rest if set_is_over else parameters.breath)

    def away(self, time_s: Array) -> Jet:
        """How far the knee is from home, as a share of its full range, at increasing instants."""
        away = Jet.constant(0.0, time_s)
        clock = Jet(time_s, np.ones_like(time_s), np.zeros_like(time_s))
        first_s, last_s = float(time_s[0]), float(time_s[-1])
        for repetition in self.repetitions:
            if repetition.start_s < last_s and repetition.end_s > first_s:
                for start_s, end_s, share in repetition.moves:
                    away = away + clock.through(smooth_step(start_s, end_s)).scaled(share)
        return away

    def in_position(self, time_s: Array) -> Jet:
        """0 while the person stands upright, 1 in the position of the exercise."""
        if self.settled_s == 0.0:
            return Jet.constant(1.0, time_s)
        clock = Jet(time_s, np.ones_like(time_s), np.zeros_like(time_s))
        return clock.through(smooth_step(self.settled_s - SETTLING_S, self.settled_s))

    def numbers(self, time_s: Array) -> Array:
        """The number of the repetition from 1, negative where it is partial; 0 in none."""
        number = np.zeros_like(time_s)
        for count, repetition in enumerate(self.repetitions, start=1):
            within = (time_s >= repetition.start_s) & (time_s < repetition.end_s)
            number[within] = -count if repetition.is_partial else count
        return number


def _repetition(parameters: KneeParameters, start_s: float, done: float, rng: np.random.Generator) -> TrueRepetition:
    """`done` of the session is over; all draws are made whether they are used or not, so that dials stay apart."""
    wobble = np.clip(rng.standard_normal(3), -2.5, 2.5) * parameters.jitter
    hesitates, is_partial = rng.uniform(size=2) < (parameters.hesitations, parameters.partials)
    stop_s, part = rng.uniform(*HALF_WAY_STOP_S), rng.uniform(*PARTIAL_RANGE)
    period_s = 60 / (parameters.tempo * (1 - parameters.slowing * done)) * (1 + wobble[0])
    reach = (1 - parameters.fatigue * done) * (1 + wobble[1]) * (part if is_partial else 1.0)
    move_s = max(period_s - parameters.hold - parameters.breath, LEAST_MOVE_S)
    out_s = move_s * min(max(0.5 * (1 + wobble[2]), 0.3), 0.7)
    moves = [(start_s, start_s + out_s, reach)]
    if hesitates:
        middle_s = start_s + out_s / 2
        moves = [(start_s, middle_s, reach / 2), (middle_s + stop_s, start_s + out_s + stop_s, reach / 2)]
    held_s = moves[-1][1]
    back_s = held_s + parameters.hold
    end_s = back_s + move_s - out_s
    moves.append((back_s, end_s, -reach))
    turn_s = math.fsum([held_s, back_s]) / 2
    return TrueRepetition(start_s, turn_s, end_s, float(reach), bool(is_partial), tuple(moves))
