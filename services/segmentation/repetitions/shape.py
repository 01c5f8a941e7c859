"""When exactly a repetition began, turned and ended, and how it moved."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.segmentation.repetitions.excursion import Excursion
from services.segmentation.repetitions.parameters import RepetitionParameters
from services.segmentation.repetitions.trail import Array, Course


class Shape(NamedTuple):
    """Indices of a course, and angles in rad."""

    start: int
    turn_ns: int
    end: int
    turn_angle: float
    hold_s: float
    """s from the first to the last sample within a share of the range from the farthest point."""
    thigh_swing: float
    """How much further forward the thigh is half-way while the knee extends than half-way while it flexes."""


def shape_of(
    course: Course, excursion: Excursion, parameters: RepetitionParameters, floor: float | None = None
) -> Shape:
    """Start and end by the speed of each way, the turn as the middle of the time it is held.

    A way begins where its speed first reaches a share of its largest one, seen from the resting end, and ends where
    the speed last has it. A sine begins 2 % of its period after its extreme by that rule; a movement that leaves a
    rest begins when it can be seen to move. Below `floor`, rad, nothing moves.
    """
    p = parameters
    out = excursion.sign * (course.smooth if floor is None else np.maximum(course.smooth, floor))
    # Smoothing to one side, as the detector does, is late by half the window, so the extremes are looked for again.
    home, end = course.at(excursion.home.captured_ns), course.at(excursion.end.captured_ns)
    farthest = home + int(np.argmax(out[home : end + 1]))
    speed = np.gradient(out, course.time_s) if len(out) > 1 else np.zeros_like(out)
    start = _onset(out[: farthest + 1], speed[: farthest + 1], home, p)
    back = slice(None, farthest - 1 if farthest else None, -1)
    mirrored_end = len(out) - 1 - end
    finish = len(out) - 1 - _onset(out[back], -speed[back], mirrored_end, p)
    reach = out[farthest] - max(out[start], out[finish])
    held = out[start : finish + 1] >= out[farthest] - p.held_share * reach
    first, last = start + int(np.argmax(held)), finish - int(np.argmax(held[::-1]))
    turn_ns = int((course.captured_ns[first] + course.captured_ns[last]) // 2)
    hold_s = float(course.time_s[last] - course.time_s[first])
    extreme = start + int(np.argmax(excursion.sign * course.angle[start : finish + 1]))
    swing = _thigh_swing(course.thigh, out, (start, farthest, finish)) * excursion.sign
    return Shape(start, turn_ns, finish, float(course.angle[extreme]), hold_s, swing)


def _onset(out: Array, speed: Array, home: int, p: RepetitionParameters) -> int:
    """Index at which the way from `home` to the last sample begins."""
    home = min(home, len(out) - 1)
    reached = out[home] + p.onset_reach * (out[-1] - out[home])
    leaving = int(np.flatnonzero(out[home:] <= reached)[-1]) + home if out[-1] > out[home] else home
    slow: NDArray[np.intp] = np.flatnonzero(speed[: leaving + 1] < p.onset_share * speed[home:].max())
    return int(slow[-1]) if len(slow) else 0


def _thigh_swing(thigh: Array, out: Array, at: tuple[int, int, int]) -> float:
    """Thigh inclination half-way on the way back minus half-way on the way out, rad."""
    start, farthest, finish = at
    middle = 0.5 * (out[farthest] + max(out[start], out[finish]))
    there = start + int(np.argmax(out[start : farthest + 1] >= middle))
    back = farthest + int(np.argmax(out[farthest : finish + 1] <= middle))
    return float(thigh[back] - thigh[there])
