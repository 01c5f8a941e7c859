"""Is this a person who faces the camera, in the unit and axes that were declared? Judged by the trunk and its sides."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import SkeletonJoint
from services.ingest.errors import WrongAxes, WrongUnits
from services.ingest.skeleton.room import ABSURD_M, placed
from services.ingest.skeleton.spine import interpolated
from services.ingest.skeleton.view import CameraView
from services.ingest.units import SCALES

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class PersonLimits:
    """Bounds of the check; wide enough for children and whoever bends or sits."""

    shortest_trunk: float = 0.15  # m, spine_base to spine_shoulder: also of a child, and of a camera that sees it badly
    longest_trunk: float = 0.9  # m
    most_lean: float = math.radians(60.0)  # rad from the vertical, in nearly all frames; nobody bends that long
    share: float = 0.9  # of the frames that must agree before axes are called wrong


LIMITS = PersonLimits()

_BASE, _TOP = SkeletonJoint.SPINE_BASE, SkeletonJoint.SPINE_SHOULDER
_RIGHT, _LEFT = SkeletonJoint.SHOULDER_RIGHT, SkeletonJoint.SHOULDER_LEFT


def check_view(
    where: str,
    view: CameraView,
    positions: Array,
    codes: NDArray[np.int64] | None,
    declared_unit: str | None = None,
    limits: PersonLimits = LIMITS,
) -> None:
    """Raises WrongUnits or WrongAxes, saying what would fit. Silent where the trunk was never seen.

    positions n x joints x 3 and codes n x joints as the camera delivers them.
    """
    metres = placed(view, positions)
    # A comparison with what is no number is false.
    seen = np.asarray((np.abs(metres) < ABSURD_M).all(axis=2))
    if codes is not None:
        seen &= view.state_numbers(codes) > 0
    metres, state = interpolated(view.joints, np.where(seen[:, :, None], metres, np.nan), seen.astype(np.int64))
    trunk = _between(view, metres, state, _BASE, _TOP)
    if len(trunk) == 0:
        return
    _check_unit(where, float(np.median(np.linalg.norm(trunk, axis=1))), view.metres, declared_unit, limits)
    _check_upright(where, trunk, limits)
    _check_sides(where, _between(view, metres, state, _LEFT, _RIGHT), limits)


def _between(
    view: CameraView, metres: Array, state: NDArray[np.int64], start: SkeletonJoint, end: SkeletonJoint
) -> Array:
    """m x 3, from one joint to another, over the frames that show both; empty where the camera lacks one."""
    if start not in view.room_joints or end not in view.room_joints:
        return np.empty((0, 3))
    a, b = view.room_joints.index(start), view.room_joints.index(end)
    both = (state[:, a] > 0) & (state[:, b] > 0)
    return np.asarray(metres[both, b] - metres[both, a])


def _check_unit(where: str, trunk_m: float, metres: float, declared: str | None, limits: PersonLimits) -> None:
    if limits.shortest_trunk <= trunk_m <= limits.longest_trunk:
        return
    advice = "check unit, numbers and joints of the camera"
    for unit, scale in SCALES["length"].items():
        if unit != declared and limits.shortest_trunk <= trunk_m / metres * scale <= limits.longest_trunk:
            advice = f'the file is rather in {unit}: write unit = "{unit}" for the camera'
    raise WrongUnits(
        f"{where}: a trunk of {trunk_m:.3g} m instead of {limits.shortest_trunk} to {limits.longest_trunk}; {advice}"
    )


def _check_upright(where: str, trunk: Array, limits: PersonLimits) -> None:
    upright = trunk[:, 1] / np.maximum(np.linalg.norm(trunk, axis=1), 1e-9)
    if (upright < -math.cos(limits.most_lean)).mean() >= limits.share:
        raise WrongAxes(
            f"{where}: the shoulders are below the hips; the camera is upside down or y points down: write axes, such "
            'as ["-z", "-y", "-x"], or the direction up'
        )
    if (np.abs(upright) < math.cos(limits.most_lean)).mean() >= limits.share:
        raise WrongAxes(
            f"{where}: the trunk lies across the direction up; check the order of axes, or give the direction up of a "
            "camera that is tilted"
        )


def _check_sides(where: str, across: Array, limits: PersonLimits) -> None:
    if len(across) and (across[:, 2] < 0).mean() >= limits.share:
        raise WrongAxes(
            f"{where}: the right shoulder is on the left of who faces the camera; turn two signs of axes if z "
            "points to the camera, record anew if the picture is mirrored or the person shows the back"
        )
