"""Marching on the spot: thighs lifted in turn, after a metronome or at an own pace. Pure.

How high and how fast a person marches is drawn from the seed, from ranges that healthy adults are seen to choose:
thighs lifted by 35 to 65 degrees, shins hanging down or tucked in a little, 0.85 to 1.1 cycles of a leg per second.
The knots are round numbers drawn by eye for a thigh lifted by 50 degrees; they are no recording of anybody. The ball of
the foot lands first and leaves last, and the heel is as high in between as the bent leg leaves it.
"""

import math

import numpy as np

from schemas.vocabulary import Task
from services.ingest.synthetic.curves import JOINT_CURVES, GaitCurves, series_through
from services.ingest.synthetic.gait import BALL_FROM_ANKLE, Gait
from services.ingest.synthetic.jets import Array, Jet
from services.ingest.synthetic.parameters import MarchParameters
from services.ingest.synthetic.session import SyntheticSession
from services.ingest.synthetic.tempo import Jittered, Metronome, OwnPace, Tempo, jet_of, random_spline
from services.ingest.synthetic.timeline import Timeline, plan_bouts

PUBLISHED_BEATS_PER_MIN = (70.0, 60.0, 50.0, 60.0, 70.0, 80.0, 70.0)
"""Of the trial whose metronome changes (figure 10)."""
BEAT_LASTS_S = 30.0
OWN_PACE_HZ = (0.85, 1.1)
LIFT = (0.61, 1.13)
"""rad, 35 to 65 deg."""
TUCK = (0.9, 1.15)
"""Knee flexion against that of the curve drawn below, at the same lift."""
SIDEWAYS = 0.5
"""Share of a walk's movement in the other degrees of freedom."""

_DRAWN_LIFT = math.radians(50.0)
_STANCE_KNEE_DEG = ((0, 30), (6, 16), (12, 6), (20, 3), (31, 2), (42, 3), (50, 6), (56, 16), (62, 30))
"""Per cent of the cycle, deg. The hip follows from it: the pelvis stays over the ball of the foot."""
_SWING_DEG = ((71, 36, 62), (81, 50, 78), (91, 36, 62))
"""Per cent of the cycle, deg of the hip, deg of the knee."""
_TOES_HANG_DEG = ((71.0, -30.0), (81.0, -33.0), (91.0, -30.0))
_ON_THE_GROUND = np.array([0, 3, 6, 9, 12, 16, 22, 31, 40, 46, 50, 53, 56, 59, 62]) / 100
"""Phases of the stance at which the foot's pitch is known."""


def marching_curves(lift: float, tuck: float, thigh_length: float, shank_length: float) -> GaitCurves:
    """Curves of a person who lifts the thighs by `lift` rad and flexes the knees `tuck` times as much as drawn."""
    share = lift / _DRAWN_LIFT
    stance = [(float(at), share * deg) for at, deg in _STANCE_KNEE_DEG]
    upright = np.degrees(_hip_over_the_ball(np.radians([deg for _, deg in stance]), thigh_length, shank_length))
    hips = [(at, deg) for (at, _), deg in zip(stance, upright.tolist(), strict=True)]
    hip = series_through([*hips, *((at, share * deg) for at, deg, _ in _SWING_DEG)])
    knee = series_through([*stance, *((at, share * tuck * deg) for at, _, deg in _SWING_DEG)])
    hip_angle, knee_angle = hip(_ON_THE_GROUND)[0], knee(_ON_THE_GROUND)[0]
    leg = thigh_length * np.cos(hip_angle) + shank_length * np.cos(knee_angle - hip_angle)
    pitch = np.degrees(_pitch_on_the_ball(thigh_length + shank_length - leg))
    hang = [(per_cent, min(deg, pitch[0], pitch[-1])) for per_cent, deg in _TOES_HANG_DEG]
    foot = series_through([*zip((100 * _ON_THE_GROUND).tolist(), pitch.tolist(), strict=True), *hang])
    sideways = {name: curve.scaled(SIDEWAYS) for name, curve in JOINT_CURVES.items()}
    return GaitCurves({**sideways, "hip_flexion": hip, "knee_flexion": knee}, foot, _always_on_the_ball)


def _hip_over_the_ball(knee: Array, thigh: float, shank: float) -> Array:
    """Hip flexion, rad, at which the ball of the foot is as far ahead of the hip as in standing.

    The ankle is ahead of the hip by thigh sin h - shank sin(knee - h) = r sin(h - a), below it by r cos(h - a), and
    has to be ahead by what the ball loses to the heel's rise.
    """
    ahead, below = thigh + shank * np.cos(knee), shank * np.sin(knee)
    r, a = np.hypot(ahead, below), np.arctan2(below, ahead)
    lean = np.zeros_like(knee)
    for _ in range(5):
        pitch = _pitch_on_the_ball(thigh + shank - r * np.cos(lean))
        lost = BALL_FROM_ANKLE[0] * (1 - np.cos(pitch)) - BALL_FROM_ANKLE[1] * np.sin(-pitch)
        lean = np.arcsin(np.clip(lost / r, -1.0, 1.0))
    return np.asarray(a + lean)


def _pitch_on_the_ball(shortening: Array) -> Array:
    """Pitch, rad, toes up positive, that lifts the ankle over a resting ball by what the leg is shorter, m.

    With the ball x ahead of the ankle and d below it: x sin(e) + d cos(e) = d + shortening, e = -pitch.
    """
    x, d = BALL_FROM_ANKLE[0], -BALL_FROM_ANKLE[1]
    sine = np.minimum((d + shortening) / math.hypot(x, d), 1.0)
    return np.asarray(math.atan2(d, x) - np.arcsin(sine))


def _always_on_the_ball(phase: Array) -> tuple[Array, Array, Array]:
    return np.ones_like(phase), np.zeros_like(phase), np.zeros_like(phase)


class SyntheticMarch(SyntheticSession):
    """Quiet standing, then marching on the spot."""

    protocol = "quiet standing, then marching on the spot"
    task = Task.MARCHING

    def __init__(self, parameters: MarchParameters) -> None:
        rng = np.random.default_rng([parameters.seed, 4])
        pace, lift, tuck = rng.uniform(*OWN_PACE_HZ), rng.uniform(*LIFT), rng.uniform(*TUCK)
        self.beat = _beat(parameters, parameters.pace or pace)
        """What the person would keep to without jitter."""
        early = random_spline(parameters.beat_jitter, 1 / self.beat.frequency_hz, parameters.duration, rng)
        tempo = Jittered(self.beat, early)
        timeline = Timeline(plan_bouts(parameters, tempo), (), 1.0, tempo)
        legs = parameters.thigh_length, parameters.shank_length
        gait = Gait(*legs, parameters.hip_width, curves=marching_curves(parameters.lift or lift, tuck, *legs))
        super().__init__(parameters, timeline, gait)
        self._lifts = random_spline(parameters.lift_jitter, 1 / tempo.frequency_hz, parameters.duration, rng)
        self.title = f"Synthetic march {_words(parameters)} (seed {parameters.seed})"

    def amplitude(self, time_s: Array) -> Jet:
        """Rises over the first cycle and falls over the last; in between no lift is quite as high as the last one."""
        return self.timeline.amplitude(time_s) * jet_of(self._lifts, time_s).shifted(1.0)


def _beat(parameters: MarchParameters, pace_hz: float) -> Tempo:
    if parameters.tempo_changes:
        beats = tuple(beat / 60 for beat in PUBLISHED_BEATS_PER_MIN)
        return Metronome(beats, tuple(parameters.standing + BEAT_LASTS_S * k for k in range(len(beats))))
    if parameters.metronome > 0:
        return Metronome((parameters.metronome / 60,), (0.0,))
    return OwnPace.drawn(pace_hz, parameters.wander, parameters.seed)


def _words(parameters: MarchParameters) -> str:
    if parameters.tempo_changes:
        return "after a metronome that changes"
    return f"after a metronome at {parameters.metronome:g} per min" if parameters.metronome else "at an own pace"
