"""Where and when each foot comes down and lifts: what is planned before anything moves, and the truth of every step."""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from schemas.vocabulary import Side
from services.ingest.synthetic.patients.manners import Manner, double_support, step_time_s
from services.ingest.synthetic.timeline import Bout

LATERAL = {Side.LEFT: -1.0, Side.RIGHT: 1.0}
"""m/m, to the right."""
LEAST_DOUBLE_SUPPORT_S = 0.03
FIRST_STEP, FIRST_STEP_LASTS = 0.6, 1.35
"""Shares of a usual step that the first one from standing is long and lasts."""
LONGEST_REACH = 0.95
"""Of a leg, by which a step may be long."""
USUAL_LEG_M = 0.81
"""Whose cadence is the usual one; longer legs swing more slowly."""
FOREVER_S = 1e5


class Footfall(NamedTuple):
    """One foot on the ground."""

    side: Side
    contact_s: float
    toe_off_s: float
    forward: float  # m of the ankle above the flat foot
    aside: float  # m, to the right

    @property
    def is_standing(self) -> bool:
        """It was there before the walk, or stays after it."""
        return self.contact_s <= 0.0 or self.toe_off_s >= FOREVER_S


class Step(NamedTuple):
    """The truth of one step."""

    side: Side  # that leads
    contact_s: float
    length: float  # m, forward between the feet
    width: float  # m
    time_s: float  # since the other foot's contact


class Footfalls:
    """All of a session, by side in order of time; the first and the last of each side are those of standing."""

    def __init__(self, by_side: dict[Side, list[Footfall]], bouts: list[list[Footfall]]) -> None:
        self.by_side = by_side
        self.bouts = bouts
        """In order of contact, without the feet that stood there before a bout."""

    def contacts_s(self, side: Side) -> list[float]:
        """Initial contacts of one foot."""
        return [one.contact_s for one in self.by_side[side][1:]]

    def toe_offs_s(self, side: Side) -> list[float]:
        """Toe-offs of one foot."""
        return [one.toe_off_s for one in self.by_side[side][:-1]]

    def steps(self) -> list[Step]:
        """From each contact to the next one, within bouts."""
        return [
            Step(
                now.side,
                now.contact_s,
                now.forward - before.forward,
                (now.aside - before.aside) * LATERAL[now.side],
                now.contact_s - before.contact_s,
            )
            for bout in self.bouts
            for before, now in pairwise(bout)
        ]


def plan_footfalls(
    how: Manner, speed: float, hip_width: float, leg_length: float, bouts: Sequence[Bout], seed: int
) -> Footfalls:
    """Steps from standing to standing in each bout, each step with a length and a time of its own."""
    rng = np.random.default_rng([seed, 6])
    step_s = step_time_s(speed, how.cadence) * math.sqrt(leg_length / USUAL_LEG_M)
    length = min(speed * step_s, LONGEST_REACH * leg_length)
    step_s = length / speed
    standing = {side: Footfall(side, -FOREVER_S, FOREVER_S, 0.0, LATERAL[side] * hip_width / 2) for side in Side}
    by_side = {side: [fall] for side, fall in standing.items()}
    walked = []
    for bout in bouts:
        fallen = _steps_of(how, length, step_s, hip_width, bout, by_side[Side.LEFT][-1].forward, rng)
        swings = _Swings(how, 1.0 - (1.0 + double_support(speed)) / 2, 2.0 * step_s)
        for fall in fallen:
            swings.lift(by_side, fall, bout.start_s, rng)
        walked.append([next(one for one in by_side[f.side] if one.contact_s == f.contact_s) for f in fallen])
    return Footfalls(by_side, walked)


def _steps_of(
    how: Manner, length: float, step_s: float, hip_width: float, bout: Bout, start: float, rng: np.random.Generator
) -> list[Footfall]:
    """The contacts of one bout; the last one brings the feet together."""
    found: list[Footfall] = []
    side, at_s, forward = Side.RIGHT, bout.start_s, start
    while True:
        late, far = (float(np.clip(rng.normal(0.0, s), -2.5 * s, 2.5 * s)) for s in (how.time_spread, how.step_spread))
        shift = 0.0 if how.affected is None else (1.0 if side is how.affected else -1.0)
        first = not found
        at_s += step_s * (1.0 + 2.0 * shift * how.stance_shift) * (1.0 + late) * (FIRST_STEP_LASTS if first else 1.0)
        closing = at_s + 1.1 * step_s > bout.end_s
        if not closing:
            share = math.exp(0.5 * shift * how.step_shift) / math.cosh(0.5 * how.step_shift)
            forward += length * share * (1.0 + far) * (FIRST_STEP if first else 1.0)
        across = hip_width if closing else how.width
        aside = LATERAL[side] * (0.5 * across + (0.0 if closing else rng.normal(0.0, 0.008)))
        found.append(Footfall(side, at_s, FOREVER_S, forward, aside))
        side = side.other
        if closing:
            last = found[-2]
            found[-2] = last._replace(aside=LATERAL[last.side] * 0.5 * hip_width)
            return found


class _Swings:
    """When the foot that comes down next had lifted."""

    def __init__(self, how: Manner, swing_share: float, stride_s: float) -> None:
        self._how, self._share, self._stride_s = how, swing_share, stride_s

    def lift(
        self, by_side: dict[Side, list[Footfall]], fall: Footfall, start_s: float, rng: np.random.Generator
    ) -> None:
        """Put the toe-off of the last footfall of this side before the next contact, and add that."""
        how, stood = self._how, by_side[fall.side][-1]
        shift = 0.0 if how.affected is None else (1.0 if fall.side is how.affected else -1.0)
        stride_s = min(fall.contact_s - stood.contact_s, 1.5 * self._stride_s)
        share = self._share + shift * how.stance_shift + float(np.clip(rng.normal(0.0, 0.006), -0.015, 0.015))
        other = by_side[fall.side.other][-1].contact_s
        earliest = max(other + LEAST_DOUBLE_SUPPORT_S, start_s + 0.35 * (fall.contact_s - start_s) * (other < start_s))
        lifted = max(fall.contact_s - share * stride_s, earliest)
        by_side[fall.side][-1] = stood._replace(toe_off_s=lifted)
        by_side[fall.side].append(fall)
