"""How patients walk: what differs between kinds of gait, between persons of a kind, and with speed.

The kinds follow what gait laboratories describe; the numbers are round and drawn by the seed within ranges, they are
nobody's recording. Shorter walk ratio, longer paretic step and shorter paretic stance after stroke: order of Olney and
Richards 1996; total double support of 0.2 of a stride at 1.4 m/s and 0.4 at 0.3 m/s: order of Murray 1964 to 1984.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from schemas.vocabulary import Side
from services.ingest.synthetic.kinds import HEALTHY, HEMIPARETIC, STEPPAGE, STIFF_KNEE
from services.ingest.synthetic.timeline import WALK_RATIO

WEAK_PUSH_OFF_S = (0.0, 0.05)
"""s, range of a leg that hardly pushes off; nobody has measured it, so all from lifting to pushing is drawn."""


@dataclass(frozen=True)
class LegManner:
    """One leg. Angles in rad, lengths in m."""

    knee_in_swing: float  # largest flexion, if the foot then clears the floor
    knee_in_stance: float  # least flexion
    knee_gives: float  # flexion beside it that takes the weight
    toes_at_contact: float  # pitch of the foot, toes up positive
    heel_rises_after: float  # share of the stance
    push: float  # share of the heel's rise that puts the hindmost ankle where `hindmost_before_toe_off_s` says
    circumduction: float  # outward swing
    hike: float  # by how much the pelvis is lifted over this leg's swing
    foremost_before_contact_s: float  # from the ankle's foremost place against the pelvis to contact
    hindmost_before_toe_off_s: float  # from its hindmost place to toe-off


@dataclass(frozen=True)
class Manner:
    """How somebody walks. Steps are named by the leg that leads them."""

    cadence: float  # of the usual cadence at a speed
    step_shift: float  # ln of the affected leg's step length over the other's
    stance_shift: float  # share of the stride by which the affected leg stands less and the other one more
    width: float  # m between the feet
    step_spread: float  # relative standard deviation of a step's length
    time_spread: float  # and of its time
    legs: dict[Side, LegManner]
    affected: Side | None
    extends_less: bool  # the hip of the affected leg


def double_support(speed: float) -> float:
    """Share of a stride on both feet, both times together."""
    return min(0.14 + 0.095 * math.exp(-0.8 * math.log(speed)), 0.5)


def step_time_s(speed: float, cadence: float) -> float:
    """s per step of somebody whose cadence is so many times the usual one, which grows with the root of the speed."""
    return 60.0 / (cadence * math.sqrt(60.0 * speed / WALK_RATIO))


def manner(kind: int, affected: Side, speed: float, seed: int) -> Manner:
    """Of one person, drawn by the seed."""
    rng = np.random.default_rng([seed, 5, kind])
    usual = _usual_leg(speed, rng)
    healthy = Manner(
        cadence=rng.uniform(0.94, 1.06),
        step_shift=rng.normal(0.0, 0.02),
        stance_shift=rng.normal(0.0, 0.004),
        width=rng.uniform(0.08, 0.13),
        step_spread=0.025,
        time_spread=0.02,
        legs=dict.fromkeys(Side, usual),
        affected=None,
        extends_less=False,
    )
    if kind == HEALTHY:
        return healthy
    change = {HEMIPARETIC: _hemiparetic, STIFF_KNEE: _stiff_knee, STEPPAGE: _steppage}[kind]
    return change(healthy, affected, rng)


def _usual_leg(speed: float, rng: np.random.Generator) -> LegManner:
    # 42 ms with deviations of 12 and 16 ms in the two people on force plates (segmentation's parameters).
    foremost_s, hindmost_s = np.clip(rng.normal(0.042, [0.01, 0.012]), 0.015, 0.07).tolist()
    pace = float(np.clip(speed / 1.3, 0.3, 1.2))
    return LegManner(
        knee_in_swing=math.radians(rng.uniform(44, 50) + 15 * pace),
        knee_in_stance=math.radians(rng.uniform(5, 10)),
        knee_gives=math.radians(1 + 12 * pace),
        toes_at_contact=math.radians(6 + 12 * pace),
        heel_rises_after=rng.uniform(0.6, 0.68),
        push=1.0,
        circumduction=rng.uniform(0.0, 0.015),
        hike=0.0,
        foremost_before_contact_s=foremost_s,
        hindmost_before_toe_off_s=hindmost_s,
    )


def _hemiparetic(usual: Manner, side: Side, rng: np.random.Generator) -> Manner:
    """Slow, unequal: a long step of a leg that bends little and swings outward, a short stance on it."""
    leg = usual.legs[side]
    paretic = LegManner(
        knee_in_swing=math.radians(rng.uniform(28, 42)),
        knee_in_stance=math.radians(rng.uniform(4, 14)),
        knee_gives=0.5 * leg.knee_gives,
        toes_at_contact=math.radians(rng.uniform(-4, 4)),
        heel_rises_after=rng.uniform(0.66, 0.74),
        push=rng.uniform(0.3, 0.6),
        circumduction=rng.uniform(0.03, 0.08),
        hike=math.radians(rng.uniform(3, 7)),
        foremost_before_contact_s=rng.uniform(0.02, 0.06),
        hindmost_before_toe_off_s=rng.uniform(*WEAK_PUSH_OFF_S),
    )
    return replace(
        usual,
        cadence=usual.cadence * rng.uniform(1.0, 1.15),
        step_shift=rng.normal(0.22, 0.15),
        stance_shift=rng.uniform(0.02, 0.06),
        width=rng.uniform(0.13, 0.2),
        step_spread=0.06,
        time_spread=0.04,
        legs={**usual.legs, side: paretic},
        affected=side,
        extends_less=True,
    )


def _stiff_knee(usual: Manner, side: Side, rng: np.random.Generator) -> Manner:
    """One knee hardly bends: the leg goes round and the pelvis is lifted over it."""
    leg = usual.legs[side]
    stiff = replace(
        leg,
        knee_in_swing=math.radians(rng.uniform(15, 30)),
        push=rng.uniform(0.4, 0.6),
        circumduction=rng.uniform(0.05, 0.1),
        hike=math.radians(rng.uniform(5, 9)),
    )
    return replace(
        usual,
        step_shift=rng.normal(0.05, 0.06),
        stance_shift=rng.uniform(0.005, 0.03),
        width=rng.uniform(0.1, 0.16),
        step_spread=0.04,
        time_spread=0.03,
        legs={**usual.legs, side: stiff},
        affected=side,
        extends_less=True,
    )


def _steppage(usual: Manner, side: Side, rng: np.random.Generator) -> Manner:
    """The foot hangs, so hip and knee lift it higher, and the toes land first or with the heel."""
    leg = usual.legs[side]
    dropped = replace(
        leg,
        knee_in_swing=leg.knee_in_swing + math.radians(rng.uniform(15, 25)),
        toes_at_contact=math.radians(rng.uniform(-12, -2)),
        heel_rises_after=rng.uniform(0.62, 0.7),
        hindmost_before_toe_off_s=rng.uniform(*WEAK_PUSH_OFF_S),
    )
    return replace(
        usual,
        step_shift=rng.normal(0.0, 0.08),
        stance_shift=rng.uniform(0.0, 0.02),
        step_spread=0.035,
        time_spread=0.025,
        legs={**usual.legs, side: dropped},
        affected=side,
    )
