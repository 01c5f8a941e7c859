"""How the pelvis goes along with the footfalls: between the feet, over the standing one, as high as the legs allow."""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from schemas.vocabulary import Side
from services.ingest.synthetic.curves import JOINT_CURVES
from services.ingest.synthetic.jets import Array, smooth_step
from services.ingest.synthetic.patients.foot_path import FootPath
from services.ingest.synthetic.patients.footfalls import LATERAL, Footfall, Footfalls
from services.ingest.synthetic.patients.manners import Manner
from services.ingest.synthetic.timeline import Bout

BEHIND_LEADING, BEFORE_AFFECTED = 0.44, 0.55
"""Shares of a step by which the hips are behind the ankle that lands; the latter where a leg stays behind whose hip
extends less than usual."""
SWAY_SHARE = 0.25
"""Of half the distance between the feet, by which the pelvis goes over the standing one."""
USUAL_STEP_M = 0.65
"""At which the pelvis turns as in the curves of the plain walker."""
SMOOTHED_S = 0.04
"""s, standard deviation over which the height follows whichever leg limits it."""
LEAST_FLEXION = math.radians(4.0)
"""Of a knee while walking; a straighter one has no direction to bend in."""
_EARLY_S = 0.5


class LegLengths(NamedTuple):
    """m."""

    thigh: float
    shank: float
    hip_width: float

    def reach(self, knee_flexion: Array) -> Array:
        """m from hip to ankle: d^2 = a^2 + b^2 + 2 a b cos q."""
        a, b = self.thigh, self.shank
        return np.asarray(np.sqrt(a * a + b * b + 2 * a * b * np.cos(knee_flexion)))


class PelvisPath(NamedTuple):
    """n instants: position (n, 3) m of the hips' middle, rotations (n,) rad."""

    position: Array
    rotation: Array
    tilt: Array
    obliquity: Array
    phase: Array  # strides of the right leg
    amplitude: Array  # 0 standing, 1 walking


def pelvis_path(
    footfalls: Footfalls,
    bouts: tuple[Bout, ...],
    how: Manner,
    body: LegLengths,
    feet: dict[Side, FootPath],
    time_s: Array,
) -> PelvisPath:
    """The whole session."""
    amplitude = _amplitude(footfalls, bouts, time_s)
    phase = _phase(footfalls, bouts, time_s)
    share = amplitude * min(_mean_step(footfalls) / USUAL_STEP_M, 1.2)
    hike = sum(
        (
            LATERAL[side] * how.legs[side].hike * 64 * (foot.swing * (1 - foot.swing)) ** 3
            for side, foot in feet.items()
        ),
        np.zeros_like(time_s),
    )
    turned = [JOINT_CURVES[f"pelvis_{name}"](phase % 1.0)[0] * share for name in ("rotation", "tilt", "obliquity")]
    rotation, tilt, obliquity = turned[0], turned[1], turned[2] + hike * amplitude
    forward, aside = _along(how, footfalls, bouts, time_s), _across(footfalls, bouts, time_s)
    level = np.column_stack([forward, np.zeros_like(forward), aside])
    path = PelvisPath(level, rotation, tilt, obliquity, phase, amplitude)
    level[:, 1] = _height(path, how, body, feet, footfalls, time_s)
    return path


def hips(path: PelvisPath, side: Side, hip_width: float) -> Array:
    """(n, 3) m from the pelvis to a hip: R (0, 0, w/2), with R = Ry(rotation) Rz(-tilt) Rx(-obliquity)."""
    half = LATERAL[side] * hip_width / 2
    up, right = half * np.sin(path.obliquity), half * np.cos(path.obliquity)
    # Rx leaves (0, up, right); Rz(-tilt) turns up into forward.
    ahead, up = up * np.sin(path.tilt), up * np.cos(path.tilt)
    cos, sin = np.cos(path.rotation), np.sin(path.rotation)
    return np.column_stack([cos * ahead + sin * right, up, cos * right - sin * ahead])


def _mean_step(footfalls: Footfalls) -> float:
    lengths = [step.length for step in footfalls.steps()]
    return float(np.mean(lengths)) if lengths else 0.0


def _amplitude(footfalls: Footfalls, bouts: tuple[Bout, ...], time_s: Array) -> Array:
    amplitude = np.zeros_like(time_s)
    for bout, falls in zip(bouts, footfalls.bouts, strict=True):
        rise, fall = smooth_step(bout.start_s, falls[0].contact_s), smooth_step(falls[-2].contact_s, _rest_s(falls))
        amplitude += rise(time_s)[0] - fall(time_s)[0]
    return amplitude


def _rest_s(falls: list[Footfall]) -> float:
    return falls[-1].contact_s + _EARLY_S


def _phase(footfalls: Footfalls, bouts: tuple[Bout, ...], time_s: Array) -> Array:
    """Whole at each contact of the right foot, half at those of the left one; every bout begins with the right one."""
    phase, at = np.full_like(time_s, 0.5), 0.5
    for bout, falls in zip(bouts, footfalls.bouts, strict=True):
        at = math.ceil(at - 0.5) + 0.5
        knots = [(bout.start_s, at), *((fall.contact_s, at + 0.5 * n) for n, fall in enumerate(falls, 1))]
        times, values = np.array(knots).T
        part = time_s >= times[0]
        phase[part] = _smooth_through(times, values, time_s[part])
        at = float(values[-1])
    return phase


def _smooth_through(times: Array, values: Array, time_s: Array) -> Array:
    spline = CubicSpline(times, values, bc_type="clamped")
    return np.asarray(spline(np.clip(time_s, times[0], times[-1])))


def _along(how: Manner, footfalls: Footfalls, bouts: tuple[Bout, ...], time_s: Array) -> Array:
    """m forward: a share of the step behind each ankle that lands; over both feet while standing."""
    path, stood = np.zeros_like(time_s), 0.0
    for bout, falls in zip(bouts, footfalls.bouts, strict=True):
        knots = [(bout.start_s - _EARLY_S, stood), (bout.start_s, stood)]
        before = stood
        for fall in falls[:-1]:
            share = BEFORE_AFFECTED if how.extends_less and fall.side is not how.affected else BEHIND_LEADING
            knots.append((fall.contact_s, fall.forward - share * (fall.forward - before)))
            before = fall.forward
        stood = falls[-1].forward
        knots += [(_rest_s(falls), stood), (_rest_s(falls) + _EARLY_S, stood)]
        times, values = np.array(knots).T
        part = time_s >= times[0]
        path[part] = _smooth_through(times, values, time_s[part])
    return path


def _across(footfalls: Footfalls, bouts: tuple[Bout, ...], time_s: Array) -> Array:
    """m to the right: half-way between the feet at each contact, towards the standing foot between contacts."""
    path = np.zeros_like(time_s)
    for bout, falls in zip(bouts, footfalls.bouts, strict=True):
        knots = [(bout.start_s - _EARLY_S, 0.0), (bout.start_s, 0.0)]
        for now, then in pairwise(falls):
            knots.append((0.5 * (now.contact_s + then.contact_s), SWAY_SHARE * now.aside))
        knots += [(_rest_s(falls), 0.0), (_rest_s(falls) + _EARLY_S, 0.0)]
        times, values = np.array(knots).T
        part = (time_s >= times[0]) & (time_s <= times[-1])
        path[part] = _smooth_through(times, values, time_s[part])
    return path


def _height(
    path: PelvisPath, how: Manner, body: LegLengths, feet: dict[Side, FootPath], footfalls: Footfalls, time_s: Array
) -> Array:
    """As high as the leg allows that limits it, smoothed, and then never so high that a knee would be straight."""
    wanted, highest = (np.full(len(time_s), np.inf) for _ in range(2))
    for side, foot in feet.items():
        hip = hips(path, side, body.hip_width)
        apart = (foot.ankle - path.position - hip)[:, [0, 2]]
        level = np.sum(apart**2, axis=1)
        least = LEAST_FLEXION * path.amplitude
        flexion = np.maximum(least, path.amplitude * _stance_flexion(how, side, footfalls, foot, time_s))
        for limit, knee in ((wanted, flexion), (highest, least)):
            up = np.sqrt(np.maximum(body.reach(knee) ** 2 - level, 0.01))
            np.minimum(limit, foot.ankle[:, 1] + up - hip[:, 1], out=limit)
    sigma = SMOOTHED_S / (time_s[1] - time_s[0])
    height = gaussian_filter1d(wanted, sigma, mode="nearest")
    # Where it is too high it is lowered, by what it is too high nearby, smoothly.
    for reach in (0.3, 0.6, 1.0, 1.5, 2.0, 3.0, 4.0):
        over = maximum_filter1d(np.maximum(height - highest, 0.0), int(2 * reach * sigma), mode="nearest")
        height = height - gaussian_filter1d(over, sigma, mode="nearest")
    return np.asarray(height)


def _stance_flexion(how: Manner, side: Side, footfalls: Footfalls, foot: FootPath, time_s: Array) -> Array:
    """Least flexion of a standing knee: what the person keeps, and a give after contact."""
    flexion = np.where(foot.swing > 0, 0.0, how.legs[side].knee_in_stance)
    for fall in footfalls.by_side[side][1:]:
        stands = slice(*np.searchsorted(time_s, [fall.contact_s, fall.toe_off_s]))
        u = (time_s[stands] - fall.contact_s) / min(fall.toe_off_s - fall.contact_s, 1.5)
        flexion[stands] += how.legs[side].knee_gives * np.where(
            u < 0.5, np.sin(np.pi * np.minimum(u, 0.5) * 2) ** 2, 0.0
        )
    return flexion
