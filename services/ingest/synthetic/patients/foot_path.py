"""Where an ankle goes, from one footfall to the next: rolling over heel and ball, and in between through the air.

On the ground the ankle turns about the heel while the toes are up and about the ball while the heel is, so that
neither slides. In the air a polynomial joins both with their velocity and acceleration.
"""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from services.ingest.synthetic.gait import BALL_FROM_ANKLE, HEEL_FROM_ANKLE
from services.ingest.synthetic.jets import Array, Jet, smooth_step
from services.ingest.synthetic.patients.footfalls import LATERAL, Footfall
from services.ingest.synthetic.patients.manners import LegManner

FLAT_AFTER = 0.17
"""Share of the stance after which the foot is flat, but it is within FLAT_WITHIN_S."""
FLAT_WITHIN_S = 0.3
LONGEST_STANCE = 2.0
"""Times the swing after it, of which the heel's rise is a share: who stands still first raises no heel early."""
MOST_HEEL_RISE = math.radians(180.0)
"""A third of which is done at toe-off."""
MOST_CLEARING_M = 0.1
TOES_UP_BY = 0.75
"""Share of the swing by which the foot is as it will land."""
HEEL_RISES_ON, LATEST_HEEL_RISE = 1.5, 1.0
"""How long a push lasts after toe-off: times that before it, but at most a share of the swing."""
ANKLE_HEIGHT = -float(BALL_FROM_ANKLE[1])
"""m above the floor, of a flat foot."""


class FootPath(NamedTuple):
    """An ankle over n instants: (n, 3) m in the room and the foot's pitch (n,) rad, toes up positive."""

    ankle: Array
    pitch: Array
    swing: Array  # share of the swing that is done, 0 on the ground


def foot_path(falls: list[Footfall], leg: LegManner, lift: float, rise: float, speed: float, time_s: Array) -> FootPath:
    """The whole session of one foot; `lift` m is how high it swings beside what its push-off gives, `rise` rad how far
    its heel rises."""
    ankle, pitch, swing = np.zeros((len(time_s), 3)), np.zeros(len(time_s)), np.zeros(len(time_s))
    for index, fall in enumerate(falls):
        before = falls[index - 1] if index else None
        stands = slice(*np.searchsorted(time_s, [fall.contact_s, fall.toe_off_s]))
        turned = _pitch(before, fall, falls[index + 1 :][:1], (leg, rise), time_s[stands])
        ankle[stands], pitch[stands] = _rolled(fall, turned).value, turned.value
    for fall, following in pairwise(falls):
        flies = slice(*np.searchsorted(time_s, [fall.toe_off_s, following.contact_s]))
        u = (time_s[flies] - fall.toe_off_s) / (following.contact_s - fall.toe_off_s)
        swing[flies] = u
        pitch[flies] = _pitch(None, fall, [following], (leg, rise), time_s[flies]).value
        lifted = _rolled(fall, _pitch(None, fall, [following], (leg, rise), np.array([fall.toe_off_s])))
        landed = _rolled(following, _landing(leg, following))
        ankle[flies] = _flown(fall, following, (lifted, landed), speed, leg.foremost_before_contact_s, u)
        ankle[flies, 1] += lift * _bump(u, 3, 5)
        ankle[flies, 1] += _clearing(ankle[flies, 1], pitch[flies], u)
        ankle[flies, 2] += LATERAL[fall.side] * leg.circumduction * _bump(u, 3, 3)
    return FootPath(ankle, pitch, swing)


def _pitch(
    before: Footfall | None, fall: Footfall, following: list[Footfall], how: tuple[LegManner, float], time_s: Array
) -> Jet:
    """Of a foot from a contact to the next one: toes down to flat, heel up, toes up again."""
    leg, rise = how
    clock = Jet(time_s, np.ones_like(time_s), np.zeros_like(time_s))
    pitch = Jet.constant(0.0, time_s)
    if before is not None and not fall.is_standing:
        toes = leg.toes_at_contact
        flat_s = fall.contact_s + min(FLAT_AFTER * (fall.toe_off_s - fall.contact_s), FLAT_WITHIN_S)
        pitch = pitch + clock.through(smooth_step(fall.contact_s, flat_s)).scaled(-toes).shifted(toes)
    if following:
        swing_s = following[0].contact_s - fall.toe_off_s
        before_s, after_s = _push_off_s(leg, fall.toe_off_s - fall.contact_s, swing_s)
        lands = 0.0 if following[0].is_standing else leg.toes_at_contact
        up = clock.through(smooth_step(fall.toe_off_s - before_s, fall.toe_off_s + after_s))
        down = clock.through(smooth_step(fall.toe_off_s, fall.toe_off_s + TOES_UP_BY * swing_s))
        pitch = pitch + up.scaled(-rise) + down.scaled(rise + lands)
    return pitch


def _push_off_s(leg: LegManner, stance_s: float, swing_s: float) -> tuple[float, float]:
    """How long the heel's rise lasts before and after toe-off."""
    before_s = (1.0 - leg.heel_rises_after) * min(stance_s, LONGEST_STANCE * swing_s)
    return before_s, min(HEEL_RISES_ON * before_s, LATEST_HEEL_RISE * swing_s)


def heel_rise(leg: LegManner, speed: float, stance_s: float, swing_s: float) -> float:
    """rad by which a heel rises whose ankle is as fast as the body, m/s, at the time before toe-off that the manner
    says: there it is hindmost against the pelvis."""
    before_s, after_s = _push_off_s(leg, stance_s, swing_s)
    at = np.array([-leg.hindmost_before_toe_off_s])
    share, rate, _ = smooth_step(-before_s, after_s)(at)

    def too_fast(rise: float) -> float:
        pitch = rise * float(share[0])
        height = BALL_FROM_ANKLE[0] * np.sin(pitch) - BALL_FROM_ANKLE[1] * np.cos(pitch)
        return rise * float(rate[0]) * float(height) - speed

    return float(brentq(too_fast, 0.0, MOST_HEEL_RISE)) if too_fast(MOST_HEEL_RISE) > 0.0 else MOST_HEEL_RISE


def _landing(leg: LegManner, fall: Footfall) -> Jet:
    return Jet.constant(0.0 if fall.is_standing else leg.toes_at_contact, np.zeros(1))


class _Rolled(NamedTuple):
    value: Array
    rate: Array
    acceleration: Array


def _rolled(fall: Footfall, pitch: Jet) -> _Rolled:
    """The ankle above a foot that turns about its heel or its ball: p - R(q) b with b the place of either."""
    toes_up = (pitch.value > 0)[:, None]
    lever = np.where(toes_up, HEEL_FROM_ANKLE, BALL_FROM_ANKLE)
    fixed = np.array([fall.forward, ANKLE_HEIGHT, fall.aside]) + lever
    cos, sin = np.cos(pitch.value), np.sin(pitch.value)
    turned = np.column_stack([cos * lever[:, 0] - sin * lever[:, 1], sin * lever[:, 0] + cos * lever[:, 1]])
    across = np.column_stack([-turned[:, 1], turned[:, 0]])
    zero = np.zeros((len(cos), 1))
    rate, acceleration = pitch.rate[:, None], pitch.acceleration[:, None]
    return _Rolled(
        fixed - np.column_stack([turned, zero]),
        np.column_stack([-rate * across, zero]),
        np.column_stack([-acceleration * across + rate**2 * turned, zero]),
    )


def _flown(
    fall: Footfall, following: Footfall, ends: tuple[_Rolled, _Rolled], speed: float, foremost_s: float, u: Array
) -> Array:
    """(n, 3): a quintic through both ends; forward bent so that the foot is as fast as the body shortly before it
    lands, which is when the ankle is foremost."""
    swing_s = following.contact_s - fall.toe_off_s
    x0, v0, a0 = (part[0] for part in ends[0])
    x1, v1, a1 = (part[0] for part in ends[1])
    quintic = _quintic(x0, v0 * swing_s, a0 * swing_s**2, x1, v1 * swing_s, a1 * swing_s**2)
    path = np.stack([u**k for k in range(6)], axis=1) @ quintic
    if following.is_standing or fall.is_standing:
        return np.asarray(path)
    at = 1.0 - min(foremost_s / swing_s, 0.25)
    rate = float(np.array([k * at ** (k - 1) for k in range(1, 6)]) @ quintic[1:, 0]) / swing_s
    bend = (speed - rate) * swing_s / (at**7 * (1 - at) ** 2 * (8 - 11 * at))
    path[:, 0] += bend * u**8 * (1 - u) ** 3
    return np.asarray(path)


def _clearing(height: Array, pitch: Array, u: Array) -> Array:
    """m by which the ankle is lifted early in swing so that neither heel nor ball of the foot dips into the floor."""
    levers = (lever[0] * np.sin(pitch) + lever[1] * np.cos(pitch) for lever in (HEEL_FROM_ANKLE, BALL_FROM_ANKLE))
    lacking = np.maximum(-np.min([height + lever for lever in levers], axis=0), 0.0)
    bump = _bump(u, 3, 10)
    early = (u > 0.02) & (u < 0.5)
    return np.asarray(bump * min((lacking[early] / bump[early]).max(initial=0.0), MOST_CLEARING_M))


def _quintic(x0: Array, v0: Array, a0: Array, x1: Array, v1: Array, a1: Array) -> Array:
    """(6, 3) coefficients of u^0 .. u^5 with these ends at u = 0 and 1."""
    left = np.array([x0, v0, a0 / 2])
    d, v, a = x1 - left.sum(axis=0), v1 - (left[1] + 2 * left[2]), a1 - 2 * left[2]
    return np.vstack([left, 10 * d - 4 * v + a / 2, -15 * d + 7 * v - a, 6 * d - 3 * v + a / 2])


def _bump(u: Array, rising: int, falling: int) -> Array:
    """u^a (1 - u)^b, 1 at its highest; its first two derivatives vanish at both ends."""
    top = rising / (rising + falling)
    return np.asarray(u**rising * (1 - u) ** falling / (top**rising * (1 - top) ** falling))
