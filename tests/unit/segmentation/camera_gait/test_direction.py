"""The walking direction of ankles and hips made by hand."""

import json
import math

import pytest

from services.segmentation.camera_gait.direction import Walker, WalkingDirection
from services.segmentation.camera_gait.parameters import CameraGaitParameters


def walker(heading, part=0.0, *, hips_turned=0.0, width=0.1):
    """Walking to `heading`, rad from x to z, with the right ankle `part` ahead of the left one, m."""
    forward, right = (math.cos(heading), math.sin(heading)), (-math.sin(heading), math.cos(heading))
    ankles = [
        tuple(sign * (0.5 * part * f + 0.5 * width * r) for f, r in zip(forward, right, strict=True))
        for sign in (-1.0, 1.0)
    ]
    turned = heading + hips_turned
    return Walker((0.0, 0.0), (ankles[0], ankles[1]), (-0.5 * math.sin(turned), 0.5 * math.cos(turned)))


def walked(heading, seconds=6.0, direction=None, from_s=0.0, **how):
    direction = direction or WalkingDirection(CameraGaitParameters())
    found = (1.0, 0.0)
    for i in range(round(seconds * 30)):
        time_s = from_s + i / 30
        found = direction.step(round(time_s * 1e9), walker(heading, 0.6 * math.sin(2 * math.pi * time_s), **how))
    return found


@pytest.mark.parametrize("heading", [0.0, 0.4, -1.2, 2.0, 3.1])
def test_ankles_that_part_tell_the_line_and_hips_which_end_is_forward(heading):
    x, z = walked(heading, hips_turned=0.25)
    assert math.hypot(x, z) == pytest.approx(1.0)
    assert math.atan2(z, x) == pytest.approx(heading, abs=0.06)


def test_who_stands_walks_where_she_faces():
    direction = WalkingDirection(CameraGaitParameters())
    for i in range(60):
        found = direction.step(round(i / 30 * 1e9), walker(0.7))
    assert math.atan2(found[1], found[0]) == pytest.approx(0.7, abs=0.01)


def test_it_follows_a_turn():
    direction = WalkingDirection(CameraGaitParameters())
    walked(0.0, direction=direction)
    x, z = walked(1.2, seconds=10.0, direction=direction, from_s=6.0)
    assert math.atan2(z, x) == pytest.approx(1.2, abs=0.1)


def test_half_a_turn_at_once_and_hips_upon_each_other_are_survived():
    direction = WalkingDirection(CameraGaitParameters())
    for i, heading in enumerate((0.0, math.pi, 0.0, math.pi)):
        x, z = direction.step(i * 10**9, walker(heading))
        assert math.hypot(x, z) == pytest.approx(1.0)
    flat = Walker((0.0, 0.0), ((0.0, 0.0), (0.0, 0.0)), (0.0, 0.0))
    assert math.hypot(*direction.step(5 * 10**9, flat)) == pytest.approx(1.0)


def test_split_and_resume():
    whole, first, second = (WalkingDirection(CameraGaitParameters()) for _ in range(3))
    walked(0.3, seconds=2.0, direction=whole)
    after = walked(0.3, seconds=2.0, direction=whole, from_s=2.0)
    walked(0.3, seconds=2.0, direction=first)
    second.restore(json.loads(json.dumps(first.snapshot())))
    assert walked(0.3, seconds=2.0, direction=second, from_s=2.0) == after
    assert second.snapshot() == whole.snapshot()
