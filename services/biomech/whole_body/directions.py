"""Where trunk and arms point: inclinations out of angles, which centres show also where single angles hide.

An arm that is lifted far aside has a well known direction although its flexion and rotation merge, and the trunk's lean
does not depend on where between pelvis and chest it bends.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import acos, atan2, cos, radians, sin, sqrt

from schemas.vocabulary import WHOLE_BODY, JointCentre, Side

TRUNK_JOINT = 0.55
"""Share of the trunk's length at which spine_mid lies."""
LARGEST_DEVIATION = radians(15.0)
"""rad. A less certain angle is not shown."""

_DOF = {dof.name: i for i, dof in enumerate(WHOLE_BODY)}
_CENTRES = tuple(JointCentre)

STEP = 1e-4
"""rad, of the differences that give a deviation."""


@dataclass(frozen=True)
class Direction:
    """`angle` takes the angles that `needs` names, rad; `shown_by` are the centres without which it is a guess."""

    needs: tuple[str, ...]
    shown_by: tuple[JointCentre, ...]
    angle: Callable[..., float]


def lean(tilt: float, obliquity: float, flexion: float) -> tuple[float, float]:
    """rad, forward and to the right: inclination of the line from spine_base to spine_shoulder, the pelvis's heading
    being forward.

    With u = Rz(-tilt) Rx(-obliquity), axes x forward, y up, z right, that line is s u y + (1 - s) u Rz(-flexion) y,
    s = TRUNK_JOINT.
    """
    ahead, along = (1.0 - TRUNK_JOINT) * sin(flexion), TRUNK_JOINT + (1.0 - TRUNK_JOINT) * cos(flexion)
    level, right = along * cos(obliquity), -along * sin(obliquity)
    up = level * cos(tilt) - ahead * sin(tilt)
    return atan2(ahead * cos(tilt) + level * sin(tilt), up), atan2(right, up)


def elevation(clavicle: float, flexion: float, adduction: float) -> float:
    """rad, between the upper arm and the trunk's downward axis, 0 hanging: the y of Rx(c) Rz(f) Rx(a) y.

    Of the right side; the left one's is the mirror image, with the same value for the same angles. A collar bone that
    lifts takes the arm outward: c turns against a.
    """
    raised = cos(clavicle) * cos(flexion) * cos(adduction) + sin(clavicle) * sin(adduction)
    return acos(min(1.0, max(-1.0, raised)))


def _arm(side: Side) -> Direction:
    needs = ("clavicle_elevation", "shoulder_flexion", "shoulder_adduction")
    seen = ("spine_base", "spine_shoulder", f"shoulder_{side}", f"elbow_{side}")
    return Direction(tuple(f"{name}_{side}" for name in needs), tuple(JointCentre(name) for name in seen), elevation)


_TRUNK = ("pelvis_tilt", "pelvis_obliquity", "trunk_flexion")
_SPINE = (JointCentre.SPINE_BASE, JointCentre.SPINE_SHOULDER)

DIRECTIONS: dict[str, Direction] = {
    "trunk_lean_forward": Direction(_TRUNK, _SPINE, lambda *angles: lean(*angles)[0]),
    "trunk_lean_right": Direction(_TRUNK, _SPINE, lambda *angles: lean(*angles)[1]),
    **{f"arm_elevation_{side}": _arm(side) for side in Side},
}
"""By name; rad. Leans as in vocabulary.MOVEMENTS."""


def directions(
    position: Sequence[float], deviation: Sequence[float], seen: Sequence[bool]
) -> dict[str, tuple[float, float]]:
    """Directions that are shown, with one deviation, rad.

    position, deviation (at least 22,) rad, in the order of WHOLE_BODY; seen (15,): the camera has seen this centre in
    the last moments. The deviation is to first order, the angles taken as independent: too large, for what pelvis and
    trunk share is told better than either.
    """
    shown = {}
    for name, direction in DIRECTIONS.items():
        if not all(seen[_CENTRES.index(centre)] for centre in direction.shown_by):
            continue
        places = [_DOF[need] for need in direction.needs]
        at = [position[place] for place in places]
        variance = sum((_slope(direction, at, k) * deviation[place]) ** 2 for k, place in enumerate(places))
        if variance <= LARGEST_DEVIATION**2:
            shown[name] = direction.angle(*at), sqrt(variance)
    return shown


def _slope(direction: Direction, at: list[float], k: int) -> float:
    # The larger of both sides: an arm that hangs is lifted by an error of either sign.
    beside = ([angle + sign * STEP * (i == k) for i, angle in enumerate(at)] for sign in (1, -1))
    here = direction.angle(*at)
    return max(abs(direction.angle(*angles) - here) for angles in beside) / STEP
