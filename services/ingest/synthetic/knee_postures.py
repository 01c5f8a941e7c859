"""How the legs follow the knee in each exercise. Pure.

Angles are drawn by eye for a healthy adult; they are no recording of anybody.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from services.ingest.synthetic.jets import Array, Jet


class Exercise(IntEnum):
    """The dial `exercise`."""

    SEATED_EXTENSION = 1
    HEEL_SLIDE = 2
    SQUAT = 3
    CYCLING = 4
    SIT_TO_STAND = 5


IN_WORDS: Mapping[Exercise, str] = {
    Exercise.SEATED_EXTENSION: "seated knee extension",
    Exercise.HEEL_SLIDE: "heel slides",
    Exercise.SQUAT: "squats",
    Exercise.CYCLING: "cycling",
    Exercise.SIT_TO_STAND: "sit to stand",
}

RESTS_FLEXED = frozenset({Exercise.SEATED_EXTENSION, Exercise.SIT_TO_STAND})
ONE_LEG = frozenset({Exercise.SEATED_EXTENSION, Exercise.HEEL_SLIDE})
"""The other leg rests; in the others both move, in cycling by turns."""

DEFAULT_RANGE: Mapping[Exercise, float] = {
    Exercise.SEATED_EXTENSION: 1.35,
    Exercise.HEEL_SLIDE: 1.5,
    Exercise.SQUAT: 1.4,
    Exercise.CYCLING: 1.2,
    Exercise.SIT_TO_STAND: 1.45,
}
"""rad."""
LEAST_FLEXION: Mapping[Exercise, float] = dict.fromkeys(Exercise, 0.1) | {Exercise.CYCLING: 0.5}
"""rad at the extended end; a saddle keeps the knee bent."""

SEATED_TILT, SADDLE_TILT = -0.2, 0.5
"""rad, the pelvis leans back on a chair and forward on a bicycle."""
SEATED_THIGH = math.pi / 2 - 0.1
SQUAT_THIGH, SQUAT_TILT = 0.62, 0.35
"""rad of thigh inclination and pelvis tilt per rad of knee flexion: the body stays over its feet."""
RISING_TILT = 0.6
"""rad that the trunk leans forward half-way between chair and standing."""
PEDAL_THIGH, PEDAL_THIGH_SWING, PEDAL_LAG = 0.75, 0.4, 0.35
"""rad: mean inclination, its amplitude, and how much later in the turn than the knee the thigh is highest."""


@dataclass(frozen=True)
class Leg:
    """Inclination of one thigh, forward from hanging, and flexion of its knee, rad."""

    thigh: Jet
    knee: Jet


def posture(exercise: Exercise, knee: Jet, most: float, legs: tuple[float, float]) -> tuple[Leg, Jet]:
    """The leg, and the pelvis tilt that goes with it, for a knee flexed by `knee`; `most` is its largest flexion, rad.

    `legs` are the lengths of thigh and shank, m. Not for cycling, whose thigh does not follow from the knee.
    """
    like = knee.value
    if exercise is Exercise.SQUAT:
        return Leg(knee.scaled(SQUAT_THIGH), knee), knee.scaled(SQUAT_TILT)
    if exercise is Exercise.HEEL_SLIDE:
        return Leg(knee.through(_lifted(*legs)).shifted(math.pi / 2), knee), Jet.constant(-math.pi / 2, like)
    if exercise is Exercise.SIT_TO_STAND:
        share = knee.scaled(1 / most)
        lean = share * share.scaled(-1.0).shifted(1.0)
        return Leg(share.scaled(SEATED_THIGH), knee), share.scaled(SEATED_TILT) + lean.scaled(4 * RISING_TILT)
    return Leg(Jet.constant(SEATED_THIGH, like), knee), Jet.constant(SEATED_TILT, like)


def pedalling(turns: Jet, size: Jet, least: float, reach: float) -> Leg:
    """A leg whose pedal has made `turns` turns from its lowest point; `size` scales how far the knee goes."""

    def around(offset: float) -> Callable[[Array], tuple[Array, Array, Array]]:
        k = 2 * math.pi

        def curve(x: Array) -> tuple[Array, Array, Array]:
            angle = k * x - offset
            return -np.cos(angle), k * np.sin(angle), k * k * np.cos(angle)

        return curve

    bend = (turns.through(around(0.0)).shifted(1.0) * size).scaled(reach / 2)
    thigh = (turns.through(around(PEDAL_LAG)) * size).scaled(PEDAL_THIGH_SWING)
    return Leg(thigh.shifted(PEDAL_THIGH), bend.shifted(least))


def _lifted(thigh: float, shank: float) -> Callable[[Array], tuple[Array, Array, Array]]:
    """How far a lying person's thigh is lifted, rad, over the knee's flexion K with the heel on the floor.

    tan a = s sin K / (t + s cos K); da/dK = N / D with N = s^2 + t s cos K and D = t^2 + s^2 + 2 t s cos K.
    """

    def curve(flexion: Array) -> tuple[Array, Array, Array]:
        sine, cosine = np.sin(flexion), np.cos(flexion)
        lift = np.arctan2(shank * sine, thigh + shank * cosine)
        n = shank**2 + thigh * shank * cosine
        d = thigh**2 + shank**2 + 2 * thigh * shank * cosine
        slope = thigh * shank * sine
        return lift, n / d, (-slope * d + 2 * slope * n) / d**2

    return curve
