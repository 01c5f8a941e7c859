"""Coordinates of OpenSim models, and which sign each of ours takes there: told by the model's range, never by a name.

`knee_angle_r` is flexion in Rajagopal's model (0 to 2.094 rad) and extension in gait10dof18musc (-2.094 to 0.175).
"""

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping
from typing import NamedTuple

from services.exports.errors import ExportError

Range = tuple[float, float]

RAJAGOPAL, GAIT_10DOF = "rajagopal", "gait10dof18musc"
RANGES: dict[str, dict[str, Range]] = {
    RAJAGOPAL: {
        "hip_flexion": (-0.524, 2.094),
        "hip_adduction": (-0.873, 0.524),
        "hip_rotation": (-0.698, 0.698),
        "knee_angle": (0.0, 2.094),
        "ankle_angle": (-0.698, 0.524),
    },
    GAIT_10DOF: {
        "hip_flexion": (-2.094, 2.094),
        "knee_angle": (-2.094, 0.175),
        "ankle_angle": (-1.571, 1.571),
    },
}
"""rad, of the right side and of the left, as in the published models. Rajagopal's pelvis has three rotations."""

PELVIS = ("pelvis_tilt", "pelvis_list", "pelvis_rotation")
LEG: dict[str, str] = {
    "hip_flexion": "hip_flexion",
    "hip_adduction": "hip_adduction",
    "hip_rotation": "hip_internal_rotation",
    "knee_angle": "knee_flexion",
    "ankle_angle": "ankle_dorsiflexion",
}
"""Coordinate without its side -> our degree of freedom without its side."""

OURS: dict[str, Range] = {"knee_flexion": (-0.175, 2.4)}
"""rad. Only a joint that moves much farther one way tells its sign by its range; the others are the same everywhere:
hip flexion, adduction and internal rotation and dorsiflexion are positive in every model of that family."""
_CLEAR = 0.25
"""rad that a range's middle must be from zero to tell a sign."""


class Coordinate(NamedTuple):
    """One column: `value = sign * angle of the degree of freedom`, rad."""

    name: str
    freedom: str
    sign: int
    limits: Range


class OpenSimModel(NamedTuple):
    """What an export must know of a model."""

    name: str
    coordinates: tuple[Coordinate, ...]
    pelvis: tuple[str, ...]
    """Rotations of its pelvis: all of PELVIS, or the tilt alone where the model moves in one plane."""


def known_model(name: str) -> OpenSimModel:
    """One of RANGES. Raises ExportError."""
    if name not in RANGES:
        known = ", ".join(RANGES)
        raise ExportError("model", f"{name!r} is none of {known}", "name one of them, or give its .osim file")
    sides = {f"{joint}_{side}": limits for joint, limits in RANGES[name].items() for side in ("r", "l")}
    return model_of(name, sides, PELVIS if name == RAJAGOPAL else PELVIS[:1])


def model_from_file(name: str, text: str) -> OpenSimModel:
    """A model as its .osim file says. Raises ExportError: not XML, or without coordinates of a leg."""
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise ExportError("model", f"{name} is not XML: {error}", "give an .osim file") from error
    ranges = {}
    for coordinate in root.iter("Coordinate"):
        if "name" in coordinate.attrib:
            ranges[coordinate.attrib["name"]] = _range(coordinate.attrib["name"], coordinate.findtext("range"))
    return model_of(name, ranges, tuple(rotation for rotation in PELVIS if rotation in ranges))


def _range(name: str, text: str | None) -> Range:
    """Two numbers. A coordinate without a range may go anywhere. Raises ExportError."""
    if text is None:
        return (-math.inf, math.inf)
    try:
        low, high = (float(word) for word in text.split())
    except ValueError as error:
        raise ExportError(f"model.{name}", f"its range is {text.strip()!r}", "give two numbers in rad") from error
    return low, high


def model_of(name: str, ranges: Mapping[str, Range], pelvis: tuple[str, ...]) -> OpenSimModel:
    """The coordinates of a leg among `ranges`, signed. Raises ExportError: there is none, or a sign is not clear."""
    found = []
    for side, letter in (("right", "r"), ("left", "l")):
        for joint, freedom in LEG.items():
            limits = ranges.get(f"{joint}_{letter}")
            if limits is not None:
                sign = sign_in(f"{joint}_{letter}", freedom, limits)
                found.append(Coordinate(f"{joint}_{letter}", f"{freedom}_{side}", sign, limits))
    if not found:
        wanted = ", ".join(f"{joint}_r" for joint in LEG)
        raise ExportError("model", f"{name} has none of {wanted}", f"use {' or '.join(RANGES)}")
    return OpenSimModel(name, tuple(found), pelvis)


def sign_in(coordinate: str, freedom: str, limits: Range) -> int:
    """1 or -1: whether a coordinate of that range is positive where ours is. Raises ExportError."""
    if freedom not in OURS:
        return 1
    middle = (limits[0] + limits[1]) / 2.0
    if not abs(middle) >= _CLEAR:
        what = f"its range {limits[0]:g} to {limits[1]:g} rad does not tell which way is flexion"
        raise ExportError(f"model.{coordinate}", what, f"use {' or '.join(RANGES)}")
    ours = sum(OURS[freedom]) / 2.0
    return 1 if middle * ours > 0 else -1
