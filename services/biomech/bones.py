"""Where the bones of the lower body are, given its joint angles. In plain numbers: who draws needs no compiler.

Frames are ISB (x forward, y up, z right); quaternions are (w, x, y, z).
"""

from collections.abc import Sequence
from math import cos, sin
from typing import NamedTuple

from schemas.session import Anthropometry
from schemas.vocabulary import LOWER_BODY, Segment, Side

SEGMENTS = (Segment.PELVIS, Segment.THIGH_RIGHT, Segment.SHANK_RIGHT, Segment.THIGH_LEFT, Segment.SHANK_LEFT)
"""Segments of the lower body, root outwards."""

Point = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]

NOT_TURNED: Quaternion = (1.0, 0.0, 0.0, 0.0)
_AXES = [dof.axis for dof in LOWER_BODY]
_FREEDOMS = {
    segment: slice(first, first + 3)
    for segment, first in zip(SEGMENTS, range(0, len(LOWER_BODY), 3), strict=True)
}  # fmt: skip


class Bone(NamedTuple):
    """A segment's frame in the world."""

    position: Point
    """m, the segment's proximal joint; of the pelvis the midpoint of the hip centres, which is the origin."""
    quat_world_from_segment: Quaternion


def bones(body: Anthropometry, position: Sequence[float]) -> dict[Segment, Bone]:
    """Frames of all segments for joint coordinates (15,) rad in the order of LOWER_BODY.

    q_segment = q_carrier q_1 q_2 q_3 and p_segment = p_carrier + q_carrier offset, the three rotations of a joint
    following each other in that order.
    """
    pelvis = Bone((0.0, 0.0, 0.0), _turned(NOT_TURNED, position, Segment.PELVIS))
    found = {Segment.PELVIS: pelvis}
    for side, half_width in ((Side.RIGHT, body.hip_width_m / 2.0), (Side.LEFT, -body.hip_width_m / 2.0)):
        thigh, shank = Segment(f"thigh_{side}"), Segment(f"shank_{side}")
        found[thigh] = _carried(pelvis, (0.0, 0.0, half_width), position, thigh)
        found[shank] = _carried(found[thigh], (0.0, -body.thigh_length_m, 0.0), position, shank)
    return found


def ankle(body: Anthropometry, shank: Bone) -> Point:
    """Ankle centre of a shank in the world, m."""
    return _moved(shank, (0.0, -body.shank_length_m, 0.0))


def rotated(q: Quaternion, v: Point) -> Point:
    """v with q applied: v + 2 w (u x v) + 2 u x (u x v), u the vector part."""
    w, x, y, z = q
    a, b, c = v
    s, t, r = 2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)
    return a + w * s + y * r - z * t, b + w * t + z * s - x * r, c + w * r + x * t - y * s


def _carried(carrier: Bone, offset: Point, position: Sequence[float], segment: Segment) -> Bone:
    return Bone(_moved(carrier, offset), _turned(carrier.quat_world_from_segment, position, segment))


def _moved(bone: Bone, offset: Point) -> Point:
    (x, y, z), (a, b, c) = bone.position, rotated(bone.quat_world_from_segment, offset)
    return x + a, y + b, z + c


def _turned(carrier: Quaternion, position: Sequence[float], segment: Segment) -> Quaternion:
    """The carrier's rotation followed by the three of the segment's joint; w >= 0."""
    w, x, y, z = carrier
    freedoms = _FREEDOMS[segment]
    for axis, angle in zip(_AXES[freedoms], position[freedoms], strict=True):
        half = 0.5 * angle
        c, s = cos(half), sin(half)
        i, j, k = s * axis[0], s * axis[1], s * axis[2]
        w, x, y, z = (
            w * c - x * i - y * j - z * k,
            w * i + x * c + y * k - z * j,
            w * j - x * k + y * c + z * i,
            w * k + x * j - y * i + z * c,
        )
    return (w, x, y, z) if w >= 0.0 else (-w, -x, -y, -z)
